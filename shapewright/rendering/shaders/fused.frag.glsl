// Three pictures in one: grey fill with dark edges (red), depth (green), slope towards the camera (blue), on white.

const float FILL = 0.74;
const float LINE = 0.08;
const float MIDDLE = 0.50;
const float SLOPE = 0.22;      // heights are within about ±1.7 times the scale

void main() {
    begin_pixel();
    bool anything;
    float covered = read_lattice(anything);
    pixel = vec4(1.0);
    if (!anything) return;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        uint s = inner_sample(i);
        sum += tint_of(s) > 0u ? vec2(clamp(MIDDLE - SLOPE * height_of(s), 0.05, 0.90), 0.10 + 0.75 * normal_of(s).z) : vec2(1.0);
    }
    pixel.rgb = vec3(mix(mix(1.0, FILL, covered), LINE, edge_darkness()), 0.25 * sum);
}
