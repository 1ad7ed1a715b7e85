// sample_map.glsl: trilinear interpolation in a map, as in the engine.

// GPUs filter textures with 8-bit weights, which is too coarse near a charge, so the eight neighbours are fetched
// there. Software renderers filter in floats, in half the time.
const bool filteredInFloats = FILTERED_IN_FLOATS;

// Whether some of the surface lies outside a map.
const bool someOutside = SOME_OUTSIDE;

float interpolated(sampler3D map, vec3 place)
{
  ivec3 size = textureSize(map, 0);
  vec3 index = place * vec3(size) - 0.5;
  vec3 low = clamp(floor(index), vec3(0.0), vec3(size - 2));
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

/// From the centre of the first grid point to that of the last.
bool isInside(sampler3D map, vec3 place)
{
  vec3 border = (0.5 - 1e-4) / vec3(textureSize(map, 0));
  return all(greaterThanEqual(place, border)) && all(lessThanEqual(place, 1.0 - border));
}

/// @param place texture coordinate: 0 to 1 from border to border, (i + 0.5) / n at the centre of the voxel of point i
/// @return value, and 1 inside the map or 0 outside
vec2 sampleMap(sampler3D map, vec3 place)
{
  if (someOutside && !isInside(map, place)) return vec2(0.0);
  if (filteredInFloats) return vec2(textureLod(map, place, 0.0).r, 1.0);
  return vec2(interpolated(map, place), 1.0);
}
