#version 430
// Places one object into its tile of the column atlas: tile 0 is at row 0, each picture's top row first.

in vec3 in_position;                     // an object's vertex, normalised
#ifdef SMOOTH
in vec3 in_normal;                       // of the corner, any sign
out vec3 normal;
#endif
#ifdef COLORED
in vec3 in_color;                        // of the vertex: red, green, blue in 0..1
out vec3 color;
#endif
in vec4 in_row_x, in_row_y, in_row_z;    // one image: rows of (scale * rotation | translation)
in vec2 in_tile_tint;                    // one image: its tile in the atlas; number of the colour

uniform float window;                    // half the width of a picture in the units of the rotated object
uniform float tile_count;

out float height;                        // towards the camera, in units of the rotated object
flat out float tint;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[2]; };

void main() {
    vec4 p = vec4(in_position, 1.0);
    vec3 v = vec3(dot(in_row_x, p), dot(in_row_y, p), dot(in_row_z, p));
    vec2 xy = v.xy / window;
    gl_ClipDistance[0] = 1.0 - xy.y;     // the neighbouring tiles above and below stay clean
    gl_ClipDistance[1] = 1.0 + xy.y;
    float rows = in_tile_tint.x + 0.5 * (1.0 - xy.y);
    gl_Position = vec4(xy.x, 2.0 * rows / tile_count - 1.0, -0.125 * v.z, 1.0);
    height = v.z;
    tint = in_tile_tint.y;
#ifdef COLORED
    color = in_color;
#endif
#ifdef SMOOTH
    normal = vec3(dot(in_row_x.xyz, in_normal), dot(in_row_y.xyz, in_normal), dot(in_row_z.xyz, in_normal));
#endif
}
