// page_molecule.cpp: the backbones of both structures, which the page draws as ribbons.
#include "page/page_molecule.h"

#include "base/error.h"
#include "base/molecule/backbone_trace.h"
#include "io/structures/run_record.h"
#include "page/page_surface.h"

namespace espdiff {
namespace {

/// @param to_target applied to the trace
nlohmann::ordered_json page_backbone(PageArrays& arrays, BackboneTrace trace, const RigidTransform& to_target) {
  for (Vec3d& point : trace.points) point = to_target.apply(point);
  for (Vec3d& side : trace.sides) side = to_target.rotate(side);
  return {{"chains", trace.chains},
          {"points", add_page_positions(arrays, trace.points)},
          {"sides", add_page_positions(arrays, trace.sides)}};
}

/// The page lacks a molecule whose target has no trace.
void require_trace(nlohmann::ordered_json& page) {
  if (!page["backbone"]["target"]["chains"].empty()) return;
  page.erase("backbone");
  page["molecule_because"] = "no molecule: the structures have no C-alpha atoms";
}

}  // namespace

void add_backbones(nlohmann::ordered_json& page, PageArrays& arrays, const std::string& prefix) {
  const RunRecord record = read_run_record(prefix + ".vtp");
  try {
    const Molecule source = read_compared(record, record.source, false, ""),
                   target = read_compared(record, record.target, false, "");
    page["backbone"] = {{"source", page_backbone(arrays, backbone_trace(source), record.source_to_target)},
                        {"target", page_backbone(arrays, backbone_trace(target), RigidTransform())}};
    require_trace(page);
  } catch (const Error& error) {
    page["molecule_because"] = std::string("no molecule: ") + error.what();
  }
}

void add_template_backbone(nlohmann::ordered_json& page, PageArrays& arrays, const nlohmann::ordered_json& record) {
  const auto& of_template = record.at("plan").at("template");
  if (!of_template.contains("backbone")) {
    page["molecule_because"] = "no molecule: the ensemble was computed by a version that did not keep it";
    return;
  }
  try {
    const BackboneTrace trace = parse_backbone_trace(of_template.at("backbone").get<std::string>());
    const auto drawn = page_backbone(arrays, trace, RigidTransform());
    page["backbone"] = {{"source", drawn}, {"target", drawn}};
    require_trace(page);
  } catch (const InputError& error) {
    page["molecule_because"] = std::string("no molecule: ") + error.what();
  }
}

}  // namespace espdiff
