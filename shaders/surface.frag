// surface.frag: looks up both potentials at this fragment and draws their difference.
// Lines that begin with //VTK:: are filled in by VTK: the outputs, and order-independent transparency.
//VTK::Output::Dec
//VTK::DepthPeeling::Dec

// Constants of the program, #defined above this file, because software renderers pay for every branch.
const bool perFragment = PER_FRAGMENT;  // otherwise interpolated between the vertices' values (no maps)
const int part = PART;                  // 0 matched, 1 unmatched
const int colourBy = COLOUR_BY;         // the numbers of RenderArray
const bool fades = FADES;
const bool toGrey = TO_GREY;  // fades to grey, and stays opaque
const bool split = SPLIT;
const bool cuts = CUTS;          // along smooth borders of unmatched parts
const bool marks = MARKS;        // grey where the place on the target is not trusted
const bool outlines = OUTLINES;  // residues, by a dark line

in vec3 positionVC;
in vec3 normalVC;
in vec3 sourcePlaceFS;
in vec3 targetPlaceFS;
in vec3 vertexPotentialFS;
in float displacementFS;
in float slipFS;
in float uncertaintyFS;
flat in float residueIndexFS;
in vec3 bordersFS;
in vec4 reasonsAFS;
in vec4 reasonsBFS;

uniform sampler3D sourceMap;
uniform sampler3D targetMap;
uniform vec4 fade;            // uncertainties of greatest and of least opacity, least opacity, greatest opacity
uniform vec2 shownColumns;    // window columns from, to: the sides of a split view
uniform float hatchPitch;     // pixels
uniform vec3 reasonColours[9];

#include "sample_map.glsl"
#include "colour_maps.glsl"
#include "blinn_phong.glsl"

const float tearEdge = -0.4;  // of bordersFS.x: inside a tear there is no surface
const int kDifference = 0, kSource = 1, kTarget = 2, kSign = 3, kDisplacement = 4, kMagnitude = 5, kResidue = 6,
          kPlain = 7, kSlip = 8, kWhy = 9, kReadBack = 10;

/// Source and target potential here, as far as they are drawn; z is 1 if the drawn quantity has a value.
vec3 potentials()
{
  if (!perFragment) return vec3(vertexPotentialFS.xy, vertexPotentialFS.z > 0.999 ? 1.0 : 0.0);
  vec2 source = colourBy == kTarget ? vec2(0.0, 1.0) : sampleMap(sourceMap, sourcePlaceFS);
  vec2 target = colourBy == kSource ? vec2(0.0, 1.0) : sampleMap(targetMap, targetPlaceFS);
  return vec3(source.x, target.x, source.y * target.y);
}

/// Of the reason that most of the surroundings have.
vec3 reasonColour()
{
  int most = 0;
  float share = 1.0 - dot(reasonsAFS, vec4(1.0)) - dot(reasonsBFS, vec4(1.0));
  for (int r = 0; r < 8; ++r) {
    float here = r < 4 ? reasonsAFS[r] : reasonsBFS[r - 4];
    if (here <= share) continue;
    share = here;
    most = r + 1;
  }
  return reasonColours[most];
}

vec3 surfaceColour()
{
  if (colourBy == kWhy) return reasonColour();
  if (colourBy == kPlain) return plainColour;
  if (colourBy == kResidue) return residueColour(residueIndexFS);
  if (colourBy == kDisplacement) return displacementFS < 0.0 ? noValueColour : scaleColour(displacementFS);
  if (colourBy == kSlip) return slipFS < 0.0 ? noValueColour : scaleColour(slipFS);
  vec3 both = potentials();
  if (both.z == 0.0) return noValueColour;
  if (colourBy == kReadBack) return bytesOf(both.y - both.x);
  // Zero agrees with either sign.
  if (colourBy == kSign) return both.x * both.y < 0.0 ? signChangeColour : sameSignColour;
  if (colourBy == kMagnitude) return scaleColour(abs(both.y - both.x));
  float value = colourBy == kSource ? both.x : colourBy == kTarget ? both.y : both.y - both.x;
  return scaleColour(value);
}

bool isUntrusted()
{
  return marks && bordersFS.z < 0.5;
}

/// 0 where the correspondence is certain, 1 where it is least certain; 0 in one grey where it is not trusted.
float fadedHere()
{
  if (part == 1 || isUntrusted()) return 0.0;
  return uncertaintyFS < 0.0 ? 1.0 : clamp((uncertaintyFS - fade.x) / (fade.y - fade.x), 0.0, 1.0);
}

/// Pales toward the paper. A surface that became transparent instead would show the borders of what lies behind it.
vec3 paled(vec3 lit)
{
  return fades && !toGrey ? mix(lit, vec3(1.0), (1.0 - fade.z / fade.w) * fadedHere()) : lit;
}

/// Diagonal stripes, fixed to the picture.
bool onStripe()
{
  return mod(gl_FragCoord.x - gl_FragCoord.y, hatchPitch) < 0.4 * hatchPitch;
}

/// Whether this is on a line of constant width in the picture.
bool onLine(float share, float pixels)
{
  return abs(share - 0.5) < 0.5 * pixels * fwidth(share);
}

void main()
{
  //VTK::Depth::Impl
  //VTK::DepthPeeling::PreColor
  if (split && (gl_FragCoord.x < shownColumns.x || gl_FragCoord.x >= shownColumns.y)) discard;
  bool atBorder = cuts && onLine(bordersFS.x, 0.2 * hatchPitch);
  bool atOutline = outlines && onLine(bordersFS.y, 0.4 * hatchPitch);
  if (cuts && part == 0 && bordersFS.x < 0.5) discard;
  if (cuts && part == 1 && (bordersFS.x >= 0.5 || bordersFS.x < tearEdge)) discard;
  vec3 colour = part == 1                    ? (onStripe() ? noValueColour : vec3(0.93))
                : isUntrusted()              ? noValueColour
                                             : surfaceColour();
  if (toGrey) colour = mix(colour, vec3(0.35), fadedHere());
  bool onLines = atBorder || atOutline;
  if (atBorder) colour = vec3(0.25);
  if (atOutline) colour = vec3(0.05);
  if (colourBy == kReadBack) {
    gl_FragData[0] = vec4(colour, 1.0);
  } else {
    vec3 lit = blinnPhong(colour, normalize(normalVC), positionVC);
    gl_FragData[0] = onLines ? vec4(lit, 1.0) : vec4(paled(lit), part == 1 ? 1.0 : fade.w);
  }
  //VTK::DepthPeeling::Impl
}
