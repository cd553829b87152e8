// Adds the wedge, rotated about the vertical by an azimuth of this cosine and sine, to the series. The including
// shader declares ORDER, VALUE (a type: of one grid point or of four), VALUE series[] and VALUE wedge[].
void add_turned(vec2 one) {
    for (int l = 0; l < ORDER; l++) {
        series[l * (l + 1)] += wedge[l * (l + 1)];
    }
    vec2 power = vec2(1.0, 0.0);
    for (int m = 1; m < ORDER; m++) {
        power = vec2(power.x * one.x - power.y * one.y, power.x * one.y + power.y * one.x);
        for (int l = m; l < ORDER; l++) {
            int place = l * (l + 1);
            VALUE cosine = wedge[place + m];
            VALUE sine = wedge[place - m];
            series[place + m] += power.x * cosine - power.y * sine;
            series[place - m] += power.x * sine + power.y * cosine;
        }
    }
}
