// blinn_phong.glsl: two lights that move with the camera; J. Blinn's half vector, per fragment.

const vec3 kLights[2] = vec3[2](vec3(-0.3790, 0.5307, 0.7581), vec3(0.5565, -0.2385, 0.7950));
const float kIntensities[2] = float[2](0.75, 0.35);
const float kAmbient = 0.28, kDiffuse = 0.82, kSpecular = 0.10;

/// The exponent of the highlight is 32, by repeated squaring, because pow() costs as much as everything else.
float highlight(float x)
{
  float x2 = x * x, x4 = x2 * x2, x8 = x4 * x4, x16 = x8 * x8;
  return x16 * x16;
}

/// @param normal   unit, outward
/// @param position of the fragment, seen from the camera
vec3 blinnPhong(vec3 colour, vec3 normal, vec3 position)
{
  vec3 toViewer = PARALLEL ? vec3(0.0, 0.0, 1.0) : normalize(-position);
  float diffuse = 0.0, specular = 0.0;
  for (int i = 0; i < 2; ++i) {
    float facing = dot(normal, kLights[i]);
    vec3 halfway = normalize(kLights[i] + toViewer);
    diffuse += kIntensities[i] * max(facing, 0.0);
    if (facing > 0.0) specular += kIntensities[i] * highlight(max(dot(normal, halfway), 0.0));
  }
  return colour * (kAmbient + kDiffuse * diffuse) + vec3(kSpecular * specular);
}
