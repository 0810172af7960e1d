#version 430
// One rectangle a picture, around the object in it; the rest stays background.

in vec4 in_rectangle;      // one image: left, bottom, right, top in units of the rotated object
uniform float window;
uniform float tile_count;
uniform int picture_size;

void main() {
    float pixel_width = 2.0 * window / float(picture_size);
    vec2 low = in_rectangle.xy - 2.0 * pixel_width, high = in_rectangle.zw + 2.0 * pixel_width;
    vec2 corner = mix(low, high, vec2(gl_VertexID & 1, gl_VertexID >> 1));
    vec2 xy = clamp(corner / window, -1.0, 1.0);
    float rows = float(gl_InstanceID) + 0.5 * (1.0 - xy.y);
    gl_Position = vec4(xy.x, 2.0 * rows / tile_count - 1.0, 0.0, 1.0);
}
