// surface.vert: places a vertex between source and target, and passes on its coordinates in both maps.
in vec4 vertexMC;            // on the target, Angstrom
in vec3 normalMC;
in vec3 startMC;             // the same point on the superposed source
in vec3 startNormalMC;
in vec3 sourcePlace;         // the unsuperposed source position in the source's map, as texture coordinate
in vec3 targetPlace;         // the mapped position in the target's map
in vec3 vertexPotential;     // source, target, and 1 where both have a value
in float displacement;       // Angstrom; negative: unknown
in float slip;               // Angstrom; negative: unknown
in float uncertainty;        // Angstrom, smoothed; negative: unknown
in float residueIndex;       // negative: none
in vec3 borders;             // shares of matched, outlined, trusted surroundings; borders lie at 0.5
in vec4 reasonsA;            // shares of surroundings by reason: slipped, on another residue, turned, disagrees;
in vec4 reasonsB;            // off the target, without partner, without potential, side chain turned; the rest: trusted

uniform mat4 MCDCMatrix;     // names that VTK's mapper sets
uniform mat4 MCVCMatrix;
uniform mat3 normalMatrix;
uniform float morph;         // 0 on the source, 1 on the target

out vec3 positionVC;
out vec3 normalVC;
out vec3 sourcePlaceFS;
out vec3 targetPlaceFS;
out vec3 vertexPotentialFS;
out float displacementFS;
out float slipFS;
out float uncertaintyFS;
flat out float residueIndexFS;
out vec3 bordersFS;
out vec4 reasonsAFS;
out vec4 reasonsBFS;

void main()
{
  vec4 placeMC = vec4(mix(startMC, vertexMC.xyz, morph), 1.0);
  gl_Position = MCDCMatrix * placeMC;
  positionVC = (MCVCMatrix * placeMC).xyz;
  normalVC = normalMatrix * mix(startNormalMC, normalMC, morph);
  sourcePlaceFS = sourcePlace;
  targetPlaceFS = targetPlace;
  vertexPotentialFS = vertexPotential;
  displacementFS = displacement;
  slipFS = slip;
  uncertaintyFS = uncertainty;
  residueIndexFS = residueIndex;
  bordersFS = borders;
  reasonsAFS = reasonsA;
  reasonsBFS = reasonsB;
}
