// Multiplies Y_lm of four directions by the band factors of four Phong lobes of unit integral, as
// basis::zonal::phong_bands, and by their scales. The including shader declares ORDER and vec4 harmonics[36].
void keep_bands(vec4 exponent, vec4 scale) {
    vec4 even = scale;
    vec4 odd = scale * (exponent + 1.0) / (exponent + 2.0);
    for (int l = 0; l < ORDER; l++) {
        bool is_odd = (l & 1) == 1;
        vec4 kept = is_odd ? odd : even;
        for (int i = l * l; i < (l + 1) * (l + 1); i++) {
            harmonics[i] *= kept;
        }
        // The band after the next.
        vec4 next = kept * (exponent - float(l)) / (exponent + float(l + 3));
        even = is_odd ? even : next;
        odd = is_odd ? next : odd;
    }
}
