// colour_maps.glsl: the colours of values. src/view/colour_map.h computes the maps (diverging in Msh, sequential of one
// hue). They arrive here as a table, because computing them would cost a software renderer a fifth of the picture.

uniform vec2 range;           // the scale's ends
uniform sampler2D colours;    // one row, from the scale's low end to its high end; sRGB, 0 to 1, like all colours
uniform vec3 noValueColour;
uniform vec3 sameSignColour;
uniform vec3 signChangeColour;
uniform vec3 plainColour;

float positionOnScale(float value)
{
  return clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
}

/// @param t place in the table, 0 to 1
vec3 tabulated(float t)
{
  return texelFetch(colours, ivec2(int(t * float(textureSize(colours, 0).x - 1) + 0.5), 0), 0).rgb;
}

vec3 scaleColour(float value)
{
  return tabulated(positionOnScale(value));
}

/// Here the table is a circle of hues. Residues' hues differ by the golden ratio, so neighbours along the chain look
/// different.
vec3 residueColour(float index)
{
  return index < 0.0 ? noValueColour : tabulated(fract(0.61803399 * index));
}

/// The value's position in `range` in 24 bits, the highest in red. Tests read it back.
vec3 bytesOf(float value)
{
  float whole = floor(positionOnScale(value) * 16777215.0 + 0.5);
  return vec3(floor(whole / 65536.0), mod(floor(whole / 256.0), 256.0), mod(whole, 256.0)) / 255.0;
}
