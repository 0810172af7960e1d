// Grey fill with dark edges on white: the style that classes are learned in.

const float FILL = 0.74;
const float LINE = 0.08;

void main() {
    begin_pixel();
    float darkness = edge_darkness();
    float covered = 0.0;
    for (int i = 0; i < oversampling * oversampling; ++i)
        covered += sample_at(pixel_corner + ivec2(i % oversampling, i / oversampling)).w > 0.0 ? 1.0 : 0.0;
    covered /= float(oversampling * oversampling);
    pixel = vec4(vec3(mix(mix(1.0, FILL, covered), LINE, darkness)), 1.0);
}
