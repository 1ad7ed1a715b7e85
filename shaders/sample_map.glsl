// sample_map.glsl: trilinear interpolation in a map, as the engine does it.

/// @param index place in grid points: whole numbers are the centres of the texture's voxels
/// @return value, and 1 inside the map or 0 outside. Eight fetches instead of one filtered one: graphics processors
/// filter with weights of 8 bits, which is too coarse beside a charge.
vec2 sampleMap(sampler3D map, vec3 index)
{
  ivec3 last = textureSize(map, 0) - 1;
  const float slack = 1e-4;
  if (any(lessThan(index, vec3(-slack))) || any(greaterThan(index, vec3(last) + slack))) return vec2(0.0);
  vec3 low = clamp(floor(index), vec3(0.0), vec3(last - 1));
  vec3 w = clamp(index - low, 0.0, 1.0);
  ivec3 i = ivec3(low);
  vec4 near = vec4(texelFetch(map, i, 0).r, texelFetch(map, i + ivec3(1, 0, 0), 0).r,
                   texelFetch(map, i + ivec3(0, 1, 0), 0).r, texelFetch(map, i + ivec3(1, 1, 0), 0).r);
  vec4 far = vec4(texelFetch(map, i + ivec3(0, 0, 1), 0).r, texelFetch(map, i + ivec3(1, 0, 1), 0).r,
                  texelFetch(map, i + ivec3(0, 1, 1), 0).r, texelFetch(map, i + ivec3(1, 1, 1), 0).r);
  vec4 plane = mix(near, far, w.z);
  vec2 line = mix(plane.xy, plane.zw, w.y);
  return vec2(mix(line.x, line.y, w.x), 1.0);
}
