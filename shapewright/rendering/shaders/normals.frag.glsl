// Colour by direction of the surface (towards the camera is blue) on white.

void main() {
    begin_pixel();
    bool anything;
    read_lattice(anything);
    pixel = vec4(1.0);
    if (!anything) return;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        uint s = inner_sample(i);
        sum += tint_of(s) > 0u ? 0.5 * normal_of(s) + 0.5 : vec3(1.0);
    }
    pixel.rgb = 0.25 * sum;
}
