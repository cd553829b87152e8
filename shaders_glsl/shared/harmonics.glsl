// Made by ridgelight_cpu::basis::glsl::glsl_harmonics, and held to it by a test.
//
// Y_lm of four unit directions (x, y, z). The including shader declares ORDER and vec4 harmonics[36].
void find_harmonics(vec4 x, vec4 y, vec4 z) {
    vec4 t;
    vec4 c1 = x;
    vec4 s1 = y;
    vec4 c2 = x * c1 - y * s1;
    vec4 s2 = x * s1 + y * c1;
    vec4 c3 = x * c2 - y * s2;
    vec4 s3 = x * s2 + y * c2;
    vec4 c4 = x * c3 - y * s3;
    vec4 s4 = x * s3 + y * c3;
    vec4 c5 = x * c4 - y * s4;
    vec4 s5 = x * s4 + y * c4;
    harmonics[0] = vec4(0.2820948);
    harmonics[2] = vec4(z * (0.48860252));
    t = vec4(0.48860252);
    harmonics[1] = s1 * t;
    harmonics[3] = c1 * t;
    if (ORDER > 2) {
        harmonics[6] = vec4(-0.31539157 + z * (z * (0.9461747)));
        t = vec4(z * (1.0925485));
        harmonics[5] = s1 * t;
        harmonics[7] = c1 * t;
        t = vec4(0.54627424);
        harmonics[4] = s2 * t;
        harmonics[8] = c2 * t;
    }
    if (ORDER > 3) {
        harmonics[12] = vec4(z * (-1.119529 + z * (z * (1.8658817))));
        t = vec4(-0.4570458 + z * (z * (2.285229)));
        harmonics[11] = s1 * t;
        harmonics[13] = c1 * t;
        t = vec4(z * (1.4453057));
        harmonics[10] = s2 * t;
        harmonics[14] = c2 * t;
        t = vec4(0.5900436);
        harmonics[9] = s3 * t;
        harmonics[15] = c3 * t;
    }
    if (ORDER > 4) {
        harmonics[20] = vec4(0.31735665 + z * (z * (-3.1735663 + z * (z * (3.7024941)))));
        t = vec4(z * (-2.0071397 + z * (z * (4.683326))));
        harmonics[19] = s1 * t;
        harmonics[21] = c1 * t;
        t = vec4(-0.47308734 + z * (z * (3.3116114)));
        harmonics[18] = s2 * t;
        harmonics[22] = c2 * t;
        t = vec4(z * (1.7701308));
        harmonics[17] = s3 * t;
        harmonics[23] = c3 * t;
        t = vec4(0.6258357);
        harmonics[16] = s4 * t;
        harmonics[24] = c4 * t;
    }
    if (ORDER > 5) {
        harmonics[30] = vec4(z * (1.7542548 + z * (z * (-8.1865225 + z * (z * (7.3678703))))));
        t = vec4(0.45294666 + z * (z * (-6.3412533 + z * (z * (9.51188)))));
        harmonics[29] = s1 * t;
        harmonics[31] = c1 * t;
        t = vec4(z * (-2.3967683 + z * (z * (7.190305))));
        harmonics[28] = s2 * t;
        harmonics[32] = c2 * t;
        t = vec4(-0.4892383 + z * (z * (4.403145)));
        harmonics[27] = s3 * t;
        harmonics[33] = c3 * t;
        t = vec4(z * (2.0756624));
        harmonics[26] = s4 * t;
        harmonics[34] = c4 * t;
        t = vec4(0.6563821);
        harmonics[25] = s5 * t;
        harmonics[35] = c5 * t;
    }
}
