#version 430
// Finds edges in a picture of (normal.x, normal.y, height, colour number): silhouettes, steps in depth, creases.

uniform sampler2D surface;
uniform int picture_size;      // pixels a side
uniform int oversampling;      // samples a side of a pixel; even
uniform float sample_spacing;  // distance of two lattice points in units of the rotated object
uniform float step_height;     // a jump in depth of this size is an edge
layout(location = 0) out vec4 pixel;

ivec2 pixel_corner;            // first sample of this pixel
ivec2 low, high;               // samples of this tile

void begin_pixel() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int side = picture_size * oversampling;
    int tile = at.y / picture_size;
    pixel_corner = at * oversampling;
    low = ivec2(0, tile * side);
    high = low + ivec2(side - 1);
}

vec4 sample_at(ivec2 position) { return texelFetch(surface, clamp(position, low, high), 0); }

vec3 normal_of(vec4 s) { return vec3(s.xy, sqrt(max(1.0 - dot(s.xy, s.xy), 0.0025))); }

// How much of an edge lies between two neighbouring samples; `along` is the unit step from a to b.
float edge_between(vec4 a, vec4 b, vec2 along) {
    if (a.w == 0.0 && b.w == 0.0) return 0.0;
    if (a.w == 0.0 || b.w == 0.0) return 1.0;
    vec3 na = normal_of(a), nb = normal_of(b);
    float crease = smoothstep(0.05, 0.22, 1.0 - dot(na, nb));          // about 18 to 39 degrees
    float rise = b.z - a.z;
    float rise_a = -dot(na.xy, along) / na.z * sample_spacing;         // where the plane of a would be at b
    float rise_b = -dot(nb.xy, along) / nb.z * sample_spacing;
    float jump = min(abs(rise - rise_a), abs(rise - rise_b));
    return max(crease, smoothstep(0.5 * step_height, step_height, jump));
}

// Darkness of lines in this pixel, 0 to 1. Looks at a lattice of 4 x 4 samples, the inner 2 x 2 of which are
// the pixel: an edge through the pixel counts fully, one at its rim a little less, so lines are smooth and
// nearly two pixels wide.
float edge_darkness() {
    int stride = oversampling / 2;
    vec4 s[16];
    bool empty = true;
    for (int i = 0; i < 16; ++i) {
        s[i] = sample_at(pixel_corner + stride * ivec2((i & 3) - 1, (i >> 2) - 1));
        empty = empty && s[i].w == 0.0;
    }
    if (empty) return 0.0;
    float across = 0.0, down = 0.0;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 3; ++column) {
            float weight = column == 1 ? 0.3 : 0.2;
            int i = row * 4 + column, j = column * 4 + row;
            across += weight * edge_between(s[i], s[i + 1], vec2(1.0, 0.0));
            down += weight * edge_between(s[j], s[j + 4], vec2(0.0, -1.0));
        }
    }
    return clamp(max(across, down), 0.0, 1.0);
}
