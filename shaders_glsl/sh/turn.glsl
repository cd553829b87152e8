// Weights of an azimuth of this width, cosine and sine, in a series: the width times 1 / sqrt(2 pi), cos m phi /
// sqrt(pi) and sin m phi / sqrt(pi), as powers of cos phi + i sin phi. The including shader declares float turn[11],
// with m at m + 5.
void turn_to(float wedge_rad, vec2 one) {
    vec2 power = one * (wedge_rad * 0.5641895835477563);
    turn[5] = wedge_rad * 0.3989422804014327;
    turn[6] = power.x;
    turn[4] = power.y;
    power = vec2(power.x * one.x - power.y * one.y, power.x * one.y + power.y * one.x);
    turn[7] = power.x;
    turn[3] = power.y;
    power = vec2(power.x * one.x - power.y * one.y, power.x * one.y + power.y * one.x);
    turn[8] = power.x;
    turn[2] = power.y;
    power = vec2(power.x * one.x - power.y * one.y, power.x * one.y + power.y * one.x);
    turn[9] = power.x;
    turn[1] = power.y;
    power = vec2(power.x * one.x - power.y * one.y, power.x * one.y + power.y * one.x);
    turn[10] = power.x;
    turn[0] = power.y;
}
