// Lambert's law under a key light, a fill light and a sky, for people; thin lines help to read flat parts.

uniform vec3 background;
uniform vec3 colors[3];        // by colour number 1 to 3
uniform float line_strength;
#ifdef COLORED
uniform sampler2D surface_colors;  // beside `surface`: colors of vertices, which replace those by number
#endif

const vec3 KEY = normalize(vec3(-0.45, 0.65, 0.75));
const vec3 FILL = normalize(vec3(0.85, 0.10, 0.35));

vec3 lit(uint s, ivec2 position) {
    vec3 n = normal_of(s);
    float light = 0.30 + 0.14 * n.y + 0.62 * max(dot(n, KEY), 0.0) + 0.20 * max(dot(n, FILL), 0.0);
#ifdef COLORED
    vec3 color = texelFetch(surface_colors, position, 0).rgb;
#else
    vec3 color = colors[int(tint_of(s)) - 1];
#endif
    return pow(color * color * light, vec3(0.5)) + 0.05 * pow(max(dot(n, normalize(KEY + vec3(0, 0, 1))), 0.0), 24.0);
}

void main() {
    begin_pixel();
    bool anything;
    read_lattice(anything);
    pixel = vec4(background, 1.0);
    if (!anything) return;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < oversampling * oversampling; ++i) {
        ivec2 position = pixel_corner + ivec2(i % oversampling, i / oversampling);
        uint s = packed_at(position);
        sum += tint_of(s) > 0u ? lit(s, position) : background;
    }
    vec3 color = sum / float(oversampling * oversampling);
    pixel.rgb = color * (1.0 - line_strength * edge_darkness());
}
