#version 430
// Finds edges in what geometry.frag packed: silhouettes, steps in depth, creases.

uniform sampler2D surface;
uniform int picture_size;      // pixels a side
uniform int oversampling;      // samples a side of a pixel; even or 1
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

uint packed_at(ivec2 position) { return packUnorm4x8(texelFetch(surface, clamp(position, low, high), 0)); }

uint tint_of(uint texel) { return texel >> 30; }

float height_of(uint texel) { return (float((texel >> 16) & 16383u) - 8192.0) / 1024.0; }

vec3 normal_of(uint texel) {
    vec2 n = (vec2(texel & 255u, (texel >> 8) & 255u) - 128.0) / 127.0;
    return vec3(n, sqrt(max(1.0 - dot(n, n), 0.0025)));
}

// How much of an edge lies between two neighbouring samples; `along` is the unit step from a to b.
float edge_between(uint a, uint b, vec2 along) {
    if (tint_of(a) == 0u || tint_of(b) == 0u) return tint_of(a) == tint_of(b) ? 0.0 : 1.0;
    vec3 na = normal_of(a), nb = normal_of(b);
    float crease = smoothstep(0.05, 0.22, 1.0 - dot(na, nb));          // about 18 to 39 degrees
    float rise = height_of(b) - height_of(a);
    float rise_a = -dot(na.xy, along) / na.z * sample_spacing;         // where the plane of a would be at b
    float rise_b = -dot(nb.xy, along) / nb.z * sample_spacing;
    float jump = min(abs(rise - rise_a), abs(rise - rise_b));
    // Eight bits of normal say little of the slope of a surface seen edge on: allow for their rounding.
    float facing = max(na.z, nb.z);
    jump -= sample_spacing * 0.006 / (facing * facing * facing);
    return max(crease, smoothstep(0.5 * step_height, step_height, jump));
}

uint lattice[12];  // of 4 x 4 samples around the pixel, without the corners: rows of 2, 4, 4 and 2

// Reads the lattice, whose inner 2 x 2 samples are the pixel (or, with one sample a pixel, it and its neighbours to the
// right and below); returns how much of the pixel is covered.
// False in `anything` means that there is only background.
float read_lattice(out bool anything) {
    int stride = max(oversampling / 2, 1);
    uint any_tint = 0u;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            bool outer_row = row == 0 || row == 3, outer_column = column == 0 || column == 3;
            if (outer_row && outer_column) continue;
            uint value = packed_at(pixel_corner + stride * ivec2(column - 1, row - 1));
            lattice[row == 0 ? column - 1 : row == 1 ? 2 + column : row == 2 ? 6 + column : 9 + column] = value;
            any_tint |= tint_of(value);
        }
    }
    anything = any_tint != 0u;
    uvec4 inner = uvec4(tint_of(lattice[3]), tint_of(lattice[4]), tint_of(lattice[7]), tint_of(lattice[8]));
    return dot(vec4(greaterThan(inner, uvec4(0u))), vec4(0.25));
}

// One of the four samples of the pixel.
uint inner_sample(int i) { return lattice[i < 2 ? 3 + i : 5 + i]; }

// Darkness of lines in this pixel, 0 to 1: an edge through the pixel counts fully, one at its rim a little
// less, so lines are smooth and nearly two pixels wide.
float edge_darkness() {
    const vec2 RIGHT = vec2(1.0, 0.0), DOWN = vec2(0.0, -1.0);
    float across = 0.0, down = 0.0;
    for (int line = 0; line < 2; ++line) {
        int r = 2 + 4 * line;  // first sample of the row
        across += 0.4 * edge_between(lattice[r], lattice[r + 1], RIGHT);
        across += 0.6 * edge_between(lattice[r + 1], lattice[r + 2], RIGHT);
        across += 0.4 * edge_between(lattice[r + 2], lattice[r + 3], RIGHT);
        down += 0.4 * edge_between(lattice[line], lattice[3 + line], DOWN);
        down += 0.6 * edge_between(lattice[3 + line], lattice[7 + line], DOWN);
        down += 0.4 * edge_between(lattice[7 + line], lattice[10 + line], DOWN);
    }
    return clamp(max(across, down), 0.0, 1.0);
}
