#version 430
// What later passes need of the nearest surface, packed into 32 bits: normal towards the camera (x, y: 8 bits
// each), height (14 bits), colour number (2 bits; 0 is the background).
// The flat normal comes from the slope of the height, so winding cannot matter and sheets have two sides.

in float height;
flat in float tint;
#ifdef SMOOTH
in vec3 normal;
#endif
uniform float samples_per_unit;
layout(location = 0) out vec4 surface;
#ifdef COLORED
in vec3 color;
layout(location = 1) out vec4 surface_color;
#endif

void main() {
    // Rows of the atlas grow downwards in the picture, hence the sign of y.
    vec2 slope = vec2(dFdx(height), -dFdy(height)) * samples_per_unit;
    vec3 n = normalize(vec3(-slope, 1.0));
#ifdef SMOOTH
    vec3 m = dot(normal, n) < 0.0 ? -normal : normal;
    n = dot(m, m) > 1e-12 ? normalize(vec3(m.xy, max(m.z, 1e-3))) : n;
#endif
    uvec2 direction = uvec2(clamp(n.xy * 127.0 + 128.5, 0.0, 255.0));
    uint level = uint(clamp(height * 1024.0 + 8192.5, 0.0, 16383.0));
    surface = unpackUnorm4x8(direction.x | (direction.y << 8) | (level << 16) | (uint(tint + 0.5) << 30));
#ifdef COLORED
    surface_color = vec4(color, 1.0);
#endif
}
