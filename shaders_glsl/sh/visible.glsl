// Made by ridgelight_cpu::basis::glsl::glsl_visible, and held to it by a test.
//
// Adds the visibility along an azimuth above elevations of sine `sin_` and cosine `cos_`, `rise` from
// the zenith, to the series. VALUE is of one texel or of four. The including shader declares ORDER,
// the azimuth's weights float turn[11], of m at m + 5, and VALUE series[36].

// By exact integrals over elevation.
void add_slices(VALUE rise, VALUE sin_, VALUE cos_) {
    VALUE t;
    t = 0.70710677 + sin_ * (-0.70710677);
    series[0] += turn[5] * t;
    t = 0.61237246 + sin_ * (sin_ * (-0.61237246));
    series[2] += turn[5] * t;
    t = 0.4330127 * rise + cos_ * (sin_ * (-0.4330127));
    series[1] += turn[4] * t;
    series[3] += turn[6] * t;
    if (ORDER > 2) {
        t = sin_ * (0.7905694 + sin_ * (sin_ * (-0.7905694)));
        series[6] += turn[5] * t;
        t = cos_ * (0.6454972 + sin_ * (sin_ * (-0.6454972)));
        series[5] += turn[4] * t;
        series[7] += turn[6] * t;
        t = 0.6454972 + sin_ * (-0.96824586 + sin_ * (sin_ * (0.3227486)));
        series[4] += turn[3] * t;
        series[8] += turn[7] * t;
    }
    if (ORDER > 3) {
        t = -0.2338536 + sin_ * (sin_ * (1.4031215 + sin_ * (sin_ * (-1.1692679))));
        series[12] += turn[5] * t;
        t = 0.10126157 * rise + cos_ * (sin_ * (0.9113542 + sin_ * (sin_ * (-1.0126157))));
        series[11] += turn[4] * t;
        series[13] += turn[6] * t;
        t = 0.64043444 + sin_ * (sin_ * (-1.2808689 + sin_ * (sin_ * (0.64043444))));
        series[10] += turn[3] * t;
        series[14] += turn[7] * t;
        t = 0.39218438 * rise + cos_ * (sin_ * (-0.6536406 + sin_ * (sin_ * (0.26145625))));
        series[9] += turn[2] * t;
        series[15] += turn[8] * t;
    }
    if (ORDER > 4) {
        t = sin_ * (-0.79549515 + sin_ * (sin_ * (2.6516504 + sin_ * (sin_ * (-1.8561553)))));
        series[20] += turn[5] * t;
        t = cos_ * (-0.07905694 + sin_ * (sin_ * (1.7392527 + sin_ * (sin_ * (-1.6601958)))));
        series[19] += turn[4] * t;
        series[21] += turn[6] * t;
        t = 0.2236068 + sin_ * (0.8385255 + sin_ * (sin_ * (-2.236068 + sin_ * (sin_ * (1.1739357)))));
        series[18] += turn[3] * t;
        series[22] += turn[7] * t;
        t = cos_ * (0.627495 + sin_ * (sin_ * (-1.25499 + sin_ * (sin_ * (0.627495)))));
        series[17] += turn[2] * t;
        series[23] += turn[8] * t;
        t = 0.591608 + sin_ * (-1.109265 + sin_ * (sin_ * (0.73951 + sin_ * (sin_ * (-0.22185299)))));
        series[16] += turn[1] * t;
        series[24] += turn[9] * t;
    }
    if (ORDER > 5) {
        t = 0.1465755 + sin_ * (sin_ * (-2.1986325 + sin_ * (sin_ * (5.130142 + sin_ * (sin_ * (-3.0780854))))));
        series[30] += turn[5] * t;
        t = 0.05017669 * rise + cos_ * (sin_ * (-0.7526503 + sin_ * (sin_ * (3.5123682 + sin_ * (sin_ * (-2.8098946))))));
        series[29] += turn[4] * t;
        series[31] += turn[6] * t;
        t = sin_ * (sin_ * (2.1240807 + sin_ * (sin_ * (-4.2481613 + sin_ * (sin_ * (2.1240807))))));
        series[28] += turn[3] * t;
        series[32] += turn[7] * t;
        t = 0.16259106 * rise + cos_ * (sin_ * (1.0297433 + sin_ * (sin_ * (-2.493063 + sin_ * (sin_ * (1.3007284))))));
        series[27] += turn[2] * t;
        series[33] += turn[8] * t;
        t = 0.61316925 + sin_ * (sin_ * (-1.8395078 + sin_ * (sin_ * (1.8395078 + sin_ * (sin_ * (-0.61316925))))));
        series[26] += turn[1] * t;
        series[34] += turn[9] * t;
        t = 0.36356467 * rise + cos_ * (sin_ * (-0.79984224 + sin_ * (sin_ * (0.63017875 + sin_ * (sin_ * (-0.19390115))))));
        series[25] += turn[0] * t;
        series[35] += turn[10] * t;
    }
}

// By ORDER coefficients of normalised Legendre polynomials (NS09 eq. 11).
void add_nlps(VALUE sin_, VALUE cos_) {
    VALUE t;
    VALUE cos2 = cos_ * cos_;
    VALUE nlp0 = 0.70710677 * (1.0 - sin_);
    VALUE nlp1 = cos2 * (0.61237246);
    VALUE nlp2 = cos2 * (sin_ * (0.7905694)) * (ORDER > 2 ? 1.0 : 0.0);
    VALUE nlp3 = cos2 * (-0.2338536 + sin_ * (sin_ * (1.1692679))) * (ORDER > 3 ? 1.0 : 0.0);
    VALUE nlp4 = cos2 * (sin_ * (-0.79549515 + sin_ * (sin_ * (1.8561553)))) * (ORDER > 4 ? 1.0 : 0.0);
    VALUE nlp5 = cos2 * (0.1465755 + sin_ * (sin_ * (-2.0520568 + sin_ * (sin_ * (3.0780854))))) * (ORDER > 5 ? 1.0 : 0.0);
    t = 1.0 * nlp0;
    series[0] += turn[5] * t;
    t = 1.0 * nlp1;
    series[2] += turn[5] * t;
    t = 0.9619124 * nlp0 + -0.2688627 * nlp2 + -0.045089643 * nlp4;
    series[1] += turn[4] * t;
    series[3] += turn[6] * t;
    if (ORDER > 2) {
        t = 1.0 * nlp2;
        series[6] += turn[5] * t;
        t = 0.93136764 * nlp1 + -0.35567188 * nlp3 + -0.069665365 * nlp5;
        series[5] += turn[4] * t;
        series[7] += turn[6] * t;
        t = 0.91287094 * nlp0 + -0.4082483 * nlp2;
        series[4] += turn[3] * t;
        series[8] += turn[7] * t;
    }
    if (ORDER > 3) {
        t = 1.0 * nlp3;
        series[12] += turn[5] * t;
        t = 0.22494666 * nlp0 + 0.88024306 * nlp2 + -0.4059584 * nlp4;
        series[11] += turn[4] * t;
        series[13] += turn[6] * t;
        t = 0.83666 * nlp1 + -0.5477226 * nlp3;
        series[10] += turn[3] * t;
        series[14] += turn[7] * t;
        t = 0.8712147 * nlp0 + -0.4870238 * nlp2 + 0.06125728 * nlp4;
        series[9] += turn[2] * t;
        series[15] += turn[8] * t;
    }
    if (ORDER > 4) {
        t = 1.0 * nlp4;
        series[20] += turn[5] * t;
        t = 0.28517193 * nlp1 + 0.8439892 * nlp3 + -0.43940982 * nlp5;
        series[19] += turn[4] * t;
        series[21] += turn[6] * t;
        t = 0.31622776 * nlp0 + 0.70710677 * nlp2 + -0.6324555 * nlp4;
        series[18] += turn[3] * t;
        series[22] += turn[7] * t;
        t = 0.754494 * nlp1 + -0.6482861 * nlp3 + 0.10158371 * nlp5;
        series[17] += turn[2] * t;
        series[23] += turn[8] * t;
        t = 0.83666 * nlp0 + -0.5345225 * nlp2 + 0.11952286 * nlp4;
        series[16] += turn[1] * t;
        series[24] += turn[9] * t;
    }
    if (ORDER > 5) {
        t = 1.0 * nlp5;
        series[30] += turn[5] * t;
        t = 0.11146458 * nlp0 + 0.29597533 * nlp2 + 0.81769717 * nlp4;
        series[29] += turn[4] * t;
        series[31] += turn[6] * t;
        t = 0.3964125 * nlp1 + 0.6055301 * nlp3 + -0.69006556 * nlp5;
        series[28] += turn[3] * t;
        series[32] += turn[7] * t;
        t = 0.3611865 * nlp0 + 0.5552509 * nlp2 + -0.7364819 * nlp4;
        series[27] += turn[2] * t;
        series[33] += turn[8] * t;
        t = 0.6866066 * nlp1 + -0.6992059 * nlp3 + 0.19920477 * nlp5;
        series[26] += turn[1] * t;
        series[34] += turn[9] * t;
        t = 0.80763763 * nlp0 + -0.56435394 * nlp2 + 0.17036106 * nlp4;
        series[25] += turn[0] * t;
        series[35] += turn[10] * t;
    }
}
