// Mirror direction of the view about the normals of four grid points: 2 (n.v) n - v, v towards the eye or straight up.
// Positions are in metres; `eye.w` is 0 where the view is from straight above.
struct Mirrored {
    vec4 east;
    vec4 north;
    vec4 up;
};

Mirrored mirrored(vec4 normal_east, vec4 normal_north, vec4 normal_up, vec4 east_m, vec4 north_m, vec4 heights, vec4 eye) {
    vec4 view_east = vec4(0.0);
    vec4 view_north = vec4(0.0);
    vec4 view_up = vec4(1.0);
    if (eye.w > 0.0) {
        view_east = eye.x - east_m;
        view_north = eye.y - north_m;
        view_up = eye.z - heights;
        vec4 largest = max(max(abs(view_east), abs(view_north)), max(abs(view_up), vec4(1e-30)));
        // An eye at a grid point views it from above.
        view_up = mix(view_up, vec4(1e-30), lessThanEqual(largest, vec4(1e-30)));
        view_east /= largest;
        view_north /= largest;
        view_up /= largest;
        vec4 shorten = inversesqrt(view_east * view_east + view_north * view_north + view_up * view_up);
        view_east *= shorten;
        view_north *= shorten;
        view_up *= shorten;
    }
    vec4 twice = 2.0 * (normal_east * view_east + normal_north * view_north + normal_up * view_up);
    return Mirrored(twice * normal_east - view_east, twice * normal_north - view_north, twice * normal_up - view_up);
}
