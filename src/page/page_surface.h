// page_surface.h: what pages with a surface share: its arrays, its limit, its scripts.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/vtk/read_vtp.h"
#include "page/page_arrays.h"
#include "scene/surface_cover.h"

namespace espdiff {

/// A text with its first letter as a sentence's.
std::string with_capital(std::string text);

/// @throws DeviceError (this build has no three.js)
void require_three();

/// @param prefix OUT, for the message
/// @throws InputError (more than kMaxPageTriangles)
void require_page_size(std::size_t n_triangles, const std::string& prefix);

/// Embedded files of three.js, and ours, in the order in which they run.
std::vector<std::string> surface_page_library();
std::vector<std::string> surface_page_scripts();

/// Coordinates, in kFineSteps of the whole: 0.001 A in 65 A.
nlohmann::ordered_json add_page_positions(PageArrays& arrays, const std::vector<Vec3d>& positions);

/// [vertex] an array of whole numbers; -1 where there is none.
/// @throws FormatError (OUT.vtp has no such array)
std::vector<std::int32_t> page_integers(const VtpContent& surface, const std::string& name, const std::string& prefix);

/// A quantity of the record: name, label, unit, and the range that covers 90 % of the values.
nlohmann::ordered_json quantity_texts(const VtpNumbers& values, const std::string& label, const std::string& unit,
                                      bool is_signed);
/// The same with its array.
nlohmann::ordered_json page_quantity(PageArrays& arrays, const VtpNumbers& values, const std::string& label,
                                     const std::string& unit, bool is_signed);

/// Widens the range of each quantity to the widest of other results.
/// @param prefix OUT
/// @param others VTP files; nothing changes without any
/// @throws IoError, FormatError, InputError; see shared_limits()
void share_page_ranges(nlohmann::ordered_json& page, const std::string& prefix, std::vector<std::string> others);

/// Which triangles a page marks, and how it calls them.
struct PageMarks {
  std::vector<std::uint8_t> unmatched, untrusted;  ///< [triangle] nonzero; the second of matched ones only; empty: none
  const char* unmatched_text = "unmatched";
};

/// The quantity `why`, and `reasons` of the record: words with the share of the surface, colour, and the share around
/// each vertex, of all that occur, in the order of kDrawnReasons. Nothing without the array `why`.
void add_page_reasons(nlohmann::ordered_json& page, PageArrays& arrays, const VtpContent& surface);

/// [triangle] nonzero entries of a cell array; empty without such an array.
std::vector<std::uint8_t> page_flags(const VtpContent& surface, const char* name);

/// `triangles`, `positions.target` and `cover` of the record: as pictures draw the surface, with smooth borders.
/// @param start [vertex] the superposed source; an ensemble's template itself
void add_page_mesh(nlohmann::ordered_json& page, PageArrays& arrays, const VtpContent& surface,
                   const std::vector<Vec3d>& start, const PageMarks& marks);

}  // namespace espdiff
