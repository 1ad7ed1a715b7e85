// colour_maps.glsl: the maps of src/view/colour_map.h: diverging in Msh, sequential of one hue, classes.

uniform vec2 range;           // the scale's ends
uniform vec4 lowEnd;          // Msh, and the hue that it has at the neutral middle
uniform vec4 highEnd;
uniform float sequentialHue;  // radians
uniform vec3 noValueColour;   // colours are sRGB, 0 to 1
uniform vec3 sameSignColour;
uniform vec3 signChangeColour;
uniform vec3 plainColour;

const float kPi = 3.14159265358979;
const float kMiddleMagnitude = 88.0;

/// Inverse of CIE's cube-root compression with its linear toe.
vec3 expandLab(vec3 f)
{
  const float toe = 6.0 / 29.0;
  return mix(3.0 * toe * toe * (f - 4.0 / 29.0), f * f * f, greaterThan(f, vec3(toe)));
}

/// CIE L*a*b* (D65) to sRGB with its gamma (IEC 61966-2-1).
vec3 labToSrgb(vec3 lab)
{
  float fy = (lab.x + 16.0) / 116.0;
  vec3 xyz = vec3(0.95047, 1.0, 1.08883) * expandLab(vec3(fy + lab.y / 500.0, fy, fy - lab.z / 200.0));
  vec3 linear = clamp(vec3(dot(vec3(3.2406, -1.5372, -0.4986), xyz), dot(vec3(-0.9689, 1.8758, 0.0415), xyz),
                           dot(vec3(0.0557, -0.2040, 1.0570), xyz)), 0.0, 1.0);
  return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
}

/// Msh, the polar form of L*a*b*: magnitude, saturation, hue.
vec3 mshToSrgb(vec3 msh)
{
  float chroma = msh.x * sin(msh.y);
  return labToSrgb(vec3(msh.x * cos(msh.y), chroma * cos(msh.z), chroma * sin(msh.z)));
}

float positionOnScale(float value)
{
  return clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
}

/// K. Moreland, "Diverging Color Maps for Scientific Visualization", ISVC 2009.
vec3 divergingColour(float value)
{
  float t = positionOnScale(value);
  vec4 end = t < 0.5 ? lowEnd : highEnd;
  float towardEnd = abs(2.0 * t - 1.0);
  return mshToSrgb(vec3(mix(kMiddleMagnitude, end.x, towardEnd), towardEnd * end.y, mix(end.w, end.z, towardEnd)));
}

/// Near-white to dark, evenly in lightness.
vec3 sequentialColour(float value)
{
  float t = positionOnScale(value);
  float chroma = 42.0 * sin(kPi * (0.04 + 0.72 * t));
  return labToSrgb(vec3(mix(95.0, 28.0, t), chroma * cos(sequentialHue), chroma * sin(sequentialHue)));
}

/// Hues a golden section apart, so that neighbours along the chain differ.
vec3 residueColour(float index)
{
  return index < 0.0 ? noValueColour : mshToSrgb(vec3(82.0, 0.55, 2.0 * kPi * fract(0.61803399 * index)));
}

/// The value's place in `range` in 24 bits, the highest in red: for tests, which read it back.
vec3 bytesOf(float value)
{
  float whole = floor(positionOnScale(value) * 16777215.0 + 0.5);
  return vec3(floor(whole / 65536.0), mod(floor(whole / 256.0), 256.0), mod(whole, 256.0)) / 255.0;
}
