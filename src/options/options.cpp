// options.cpp: names of a comparison's choices, and the thesis' options.
#include "options/options.h"
#include "base/error.h"

namespace espdiff {

DeformField parse_deform_field(const std::string& text) {
  if (text == "density") return DeformField::kDensity;
  if (text == "distance") return DeformField::kDistance;
  if (text == "gvf") return DeformField::kGvf;
  if (text == "gvf2") return DeformField::kGvf2;
  throw InputError("unknown field '" + text + "'; use density, distance, gvf or gvf2");
}

std::string to_string(DeformField field) {
  switch (field) {
    case DeformField::kDensity: return "density";
    case DeformField::kDistance: return "distance";
    case DeformField::kGvf: return "gvf";
    case DeformField::kGvf2: return "gvf2";
  }
  return "";
}

Method parse_method(const std::string& text) {
  if (text == "deform") return Method::kDeform;
  if (text == "morph") return Method::kMorph;
  throw InputError("unknown method '" + text + "'; use deform or morph");
}

std::string to_string(Method method) { return method == Method::kMorph ? "morph" : "deform"; }

Interpolation parse_interpolation(const std::string& text) {
  if (text == "trilinear") return Interpolation::kTrilinear;
  if (text == "tricubic") return Interpolation::kTricubic;
  throw InputError("unknown interpolation '" + text + "'; use trilinear or tricubic");
}

CompareOptions thesis_options() {
  CompareOptions options;
  options.method = Method::kDeform;
  options.surface.project = false;
  options.surface.cavities = true;
  options.regularize.tangential_gain = options.deform.tangential_gain = 1;
  options.regularize.momentum = 0;
  options.deform.rest_shape = false;
  options.deform_min_displacement = options.regularize_min_displacement = 1e-3;
  return options;
}

}  // namespace espdiff
