// sample_map.glsl: trilinear interpolation in a map, as the engine does it.

// Graphics processors filter with weights of 8 bits, which is too coarse beside a charge: there the eight neighbours are
// fetched. Renderers in software filter in floats, and in half the time.
const bool filteredInFloats = FILTERED_IN_FLOATS;

float interpolated(sampler3D map, vec3 index, ivec3 last)
{
  vec3 low = clamp(floor(index), vec3(0.0), vec3(last - 1));
  vec3 w = clamp(index - low, 0.0, 1.0);
  ivec3 i = ivec3(low);
  vec4 front = vec4(texelFetch(map, i, 0).r, texelFetch(map, i + ivec3(1, 0, 0), 0).r,
                    texelFetch(map, i + ivec3(0, 1, 0), 0).r, texelFetch(map, i + ivec3(1, 1, 0), 0).r);
  vec4 back = vec4(texelFetch(map, i + ivec3(0, 0, 1), 0).r, texelFetch(map, i + ivec3(1, 0, 1), 0).r,
                   texelFetch(map, i + ivec3(0, 1, 1), 0).r, texelFetch(map, i + ivec3(1, 1, 1), 0).r);
  vec4 plane = mix(front, back, w.z);
  vec2 line = mix(plane.xy, plane.zw, w.y);
  return mix(line.x, line.y, w.x);
}

/// @param index place in grid points: whole numbers are the centres of the texture's voxels
/// @return value, and 1 inside the map or 0 outside
vec2 sampleMap(sampler3D map, vec3 index)
{
  ivec3 size = textureSize(map, 0);
  const float slack = 1e-4;
  if (any(lessThan(index, vec3(-slack))) || any(greaterThan(index, vec3(size - 1) + slack))) return vec2(0.0);
  if (filteredInFloats) return vec2(textureLod(map, (index + 0.5) / vec3(size), 0.0).r, 1.0);
  return vec2(interpolated(map, index, size - 1), 1.0);
}
