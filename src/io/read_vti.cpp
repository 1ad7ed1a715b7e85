// read_vti.cpp: VTK's image reader, with its errors caught and its result checked.
#include "io/read_vti.h"

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkDataCompressor.h>
#include <vtkDataObject.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/grid_checks.h"
#include "io/gzip_text.h"
#include "io/text_cursor.h"

namespace espdiff {
namespace {

/// Takes VTK's error and warning events, which VTK prints when nobody listens, and remembers the first.
class ErrorListener : public vtkCommand {
 public:
  static ErrorListener* New() { return new ErrorListener; }

  void Execute(vtkObject*, unsigned long, void* text) override {  // NOLINT(readability-identifier-naming)
    if (first_.empty() && text != nullptr) first_ = static_cast<const char*>(text);
  }

  bool heard_any() const { return !first_.empty(); }

  /// VTK's "ERROR: In file.cxx, line 1\nvtkClass (0x1): message" without what is of no use to users.
  std::string message() const {
    std::string text = first_;
    const std::size_t address = text.find("): ");
    if (address != std::string::npos) text.erase(0, address + 3);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return std::string(trimmed(text));
  }

 private:
  std::string first_;
};

void listen(vtkObject* object, ErrorListener* listener) {
  object->AddObserver(vtkCommand::ErrorEvent, listener);
  object->AddObserver(vtkCommand::WarningEvent, listener);
}

[[noreturn]] void fail_as_damaged(const std::string& path, const ErrorListener& listener, unsigned long code) {
  std::string why = listener.heard_any() ? listener.message() : std::string();
  if (why.empty() && code != vtkErrorCode::NoError) why = vtkErrorCode::GetStringFromErrorCode(code);
  throw FormatError(path, 0,
                    "VTK cannot read this VTI file, which is damaged or cut short" +
                        (why.empty() ? std::string() : " (" + why + ")") + "; write or fetch it again");
}

/// A VTI file ends with </VTKFile>; VTK itself returns zeros for some that do not.
void check_end_tag(const std::string& path, const std::string& bytes) {
  const std::size_t end = bytes.rfind("</VTKFile>");
  if (end == std::string::npos || bytes.find_first_not_of(" \t\r\n", end + 10) != std::string::npos) {
    throw FormatError(path, 0, "the VTI file is cut short: it does not end with </VTKFile>; write or fetch it again");
  }
}

/// VTK leaves points that no piece covers as they are in memory. Pieces share points at their borders, so cells are
/// counted.
void check_domains(const std::string& path, const std::string& bytes, const Lattice& lattice) {
  const std::string_view text = std::string_view(bytes).substr(0, bytes.find("<AppendedData"));
  long long n_cells = 0;
  for (std::size_t piece = text.find("<Piece"); piece != std::string_view::npos;
       piece = text.find("<Piece", piece + 1)) {
    const std::string_view tag = text.substr(piece, text.find('>', piece) - piece);
    const std::size_t extent = tag.find("Extent=");
    if (extent == std::string_view::npos) continue;
    TextCursor cursor(tag.substr(extent + 8, tag.find_first_of("\"'", extent + 8) - extent - 8), path);
    long long product = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const long long first = cursor.next_integer("a piece's extent");
      product *= cursor.next_integer("a piece's extent") - first;
    }
    n_cells += product;
  }
  const auto& size = lattice.size;
  const long long expected = (size[0] - 1LL) * (size[1] - 1LL) * (size[2] - 1LL);
  if (n_cells == expected) return;
  throw FormatError(path, 0,
                    "the pieces of the VTI file have " + std::to_string(n_cells) + " cells, but WholeExtent has " +
                        std::to_string(expected) + "; they must cover it exactly");
}

Lattice read_lattice(vtkXMLImageDataReader* reader, const std::string& path, const std::string& bytes) {
  std::array<int, 6> extent{};
  vtkInformation* const information = reader->GetOutputInformation(0);
  information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
  std::array<long long, 3> counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts[axis] = static_cast<long long>(extent[2 * axis + 1]) - extent[2 * axis] + 1;
  }
  Lattice lattice;
  lattice.size = check_counts(counts, path, 0);

  // Packed, a value takes almost nothing, but no packer of VTK's goes below a ten-thousandth of a byte.
  constexpr std::size_t kBestPacking = 10000;
  const bool packed = bytes.find("compressor=") < bytes.find("<ImageData");
  const std::size_t least = packed ? lattice.n_points() / kBestPacking : lattice.n_points();
  check_size_promise(lattice.n_points(), least, bytes.size(), path, 0);
  check_domains(path, bytes, lattice);
  return lattice;
}

/// Point (i, j, k) of the whole extent lies at origin + direction * (spacing * (extent start + ijk)).
void place_lattice(vtkImageData* image, Lattice& lattice) {
  const std::array<int, 6> extent = [&] {
    std::array<int, 6> e{};
    image->GetExtent(e.data());
    return e;
  }();
  const vtkMatrix3x3* const direction = image->GetDirectionMatrix();
  const double* const spacing = image->GetSpacing();
  const double* const origin = image->GetOrigin();
  lattice.origin = {origin[0], origin[1], origin[2]};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d& step = lattice.step[static_cast<std::size_t>(axis)];
    for (int row = 0; row < 3; ++row) step[row] = spacing[axis] * direction->GetElement(row, axis);
    lattice.origin += static_cast<double>(extent[2 * static_cast<std::size_t>(axis)]) * step;
  }
}

std::string list_arrays(vtkPointData* arrays) {
  std::string names;
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
    const char* const name = arrays->GetArrayName(i);
    names += (i > 0 ? ", '" : "'") + std::string(name != nullptr ? name : "") + "'";
  }
  return names.empty() ? "none" : names;
}

vtkDataArray* choose_array(vtkImageData* image, const std::string& wanted, const std::string& path) {
  vtkPointData* const arrays = image->GetPointData();
  vtkDataArray* array = nullptr;
  if (!wanted.empty()) {
    array = arrays->GetArray(wanted.c_str());
    if (array == nullptr) {
      throw InputError(path + ": has no point array '" + wanted + "'; it has " + list_arrays(arrays));
    }
  } else {
    array = arrays->GetScalars();
    if (array == nullptr && arrays->GetNumberOfArrays() == 1) array = arrays->GetArray(0);
  }
  if (array == nullptr) {
    throw InputError(
        path + ": no point array is marked as scalars; choose one by name (point arrays: " + list_arrays(arrays) + ")");
  }
  if (array->GetNumberOfComponents() != 1) {
    throw InputError(path + ": point array '" + (array->GetName() != nullptr ? array->GetName() : "") + "' has " +
                     std::to_string(array->GetNumberOfComponents()) + " components; one number a point was expected");
  }
  return array;
}

void copy_values(vtkDataArray* array, Grid& grid) {
  const std::size_t n_points = grid.lattice.n_points();
  if (static_cast<std::size_t>(array->GetNumberOfTuples()) != n_points) {
    throw FormatError(grid.name, 0,
                      "the array has " + std::to_string(array->GetNumberOfTuples()) + " values, but the grid " +
                          std::to_string(n_points) + " points; the file is damaged");
  }
  allocate_values(grid);
  for (std::size_t i = 0; i < n_points; ++i) {
    const double value = array->GetComponent(static_cast<vtkIdType>(i), 0);
    grid.values[i] = static_cast<float>(value);
    if (std::isfinite(grid.values[i])) continue;
    throw FormatError(
        grid.name, 0,
        "value " + std::to_string(i + 1) + " is " + std::to_string(value) + "; a finite number was expected");
  }
}

/// Throws when anything was reported since the reader was connected.
void check_reader(vtkXMLImageDataReader* reader, const std::string& path, const ErrorListener& listener) {
  if (listener.heard_any() || reader->GetErrorCode() != vtkErrorCode::NoError) {
    fail_as_damaged(path, listener, reader->GetErrorCode());
  }
}

/// Connects the listener and reads the header. Returns the file's bytes.
std::string open_image(vtkXMLImageDataReader* reader, const std::string& path, ErrorListener* listener) {
  listen(reader, listener);
  listen(reader->GetExecutive(), listener);
  reader->SetReaderErrorObserver(listener);
  reader->SetParserErrorObserver(listener);
  reader->SetFileName(path.c_str());

  std::string bytes = read_text_file(path);
  check_end_tag(path, bytes);
  reader->UpdateInformation();
  check_reader(reader, path, *listener);
  return bytes;
}

Grid read_with(vtkXMLImageDataReader* reader, const std::string& path, const GridOptions& options) {
  vtkNew<ErrorListener> listener;
  const std::string bytes = open_image(reader, path, listener);
  Grid grid;
  grid.name = path;
  grid.lattice = read_lattice(reader, path, bytes);
  // The compressor exists only now; its errors would go to the terminal.
  if (vtkDataCompressor* const compressor = reader->GetXMLParser()->GetCompressor()) listen(compressor, listener);
  reader->Update();
  check_reader(reader, path, *listener);
  place_lattice(reader->GetOutput(), grid.lattice);
  check_axes(grid.lattice, path, 0);
  copy_values(choose_array(reader->GetOutput(), options.array, path), grid);
  return grid;
}

}  // namespace

Grid read_vti(const std::string& path, const GridOptions& options) {
  try {
    vtkNew<vtkXMLImageDataReader> reader;
    return read_with(reader, path, options);
  } catch (const std::bad_alloc&) {
    throw MemoryError(path + ": the VTI map does not fit into memory; crop or coarsen it");
  }
}

std::vector<std::string> list_vti_scalars(const std::string& path) {
  vtkNew<vtkXMLImageDataReader> reader;
  vtkNew<ErrorListener> listener;
  open_image(reader, path, listener);
  std::vector<std::string> names;
  vtkInformationVector* const arrays = reader->GetOutputInformation(0)->Get(vtkDataObject::POINT_DATA_VECTOR());
  const int n_arrays = arrays != nullptr ? arrays->GetNumberOfInformationObjects() : 0;
  for (int i = 0; i < n_arrays; ++i) {
    vtkInformation* const array = arrays->GetInformationObject(i);
    const char* const name = array->Get(vtkDataObject::FIELD_NAME());
    const bool is_scalar = array->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()) == 1;
    if (is_scalar) names.emplace_back(name != nullptr ? name : "");
  }
  return names;
}

}  // namespace espdiff
