#version 430
// What later passes need of the nearest surface: normal towards the camera (x, y), height, colour number.
// The flat normal comes from the slope of the height, so winding cannot matter and sheets have two sides.

in float height;
flat in float tint;
#ifdef SMOOTH
in vec3 normal;
#endif
uniform float samples_per_unit;
layout(location = 0) out vec4 surface;

void main() {
    // Rows of the atlas grow downwards in the picture, hence the sign of y.
    vec2 slope = vec2(dFdx(height), -dFdy(height)) * samples_per_unit;
    vec3 n = normalize(vec3(-slope, 1.0));
#ifdef SMOOTH
    vec3 m = dot(normal, n) < 0.0 ? -normal : normal;
    n = dot(m, m) > 1e-12 ? normalize(vec3(m.xy, max(m.z, 1e-3))) : n;
#endif
    surface = vec4(n.xy, height, tint);
}
