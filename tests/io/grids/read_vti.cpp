// read_vti.cpp: VTI maps in all encodings, and damaged ones, which are refused in one line; numbers of a VTP.
#include <fcntl.h>
#include <unistd.h>
#include <cstring>

#include "base/error.h"
#include "io/grids/read_grid.h"
#include "io/grids/read_vti.h"
#include "io/vtk/read_vtp.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

/// Sends stdout and stderr to a file while it lives.
class CapturedOutput {
 public:
  explicit CapturedOutput(std::string path) : path_(std::move(path)) {
    std::fflush(nullptr);
    for (int fd : {1, 2}) saved_[fd - 1] = dup(fd);
    const int file = open(path_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    for (int fd : {1, 2}) dup2(file, fd);
    close(file);
  }
  ~CapturedOutput() { restore(); }
  CapturedOutput(const CapturedOutput&) = delete;
  CapturedOutput& operator=(const CapturedOutput&) = delete;

  std::string text() {
    restore();
    return read_file(path_);
  }

 private:
  void restore() {
    std::fflush(nullptr);
    for (int fd : {1, 2}) {
      if (saved_[fd - 1] < 0) continue;
      dup2(saved_[fd - 1], fd);
      close(saved_[fd - 1]);
      saved_[fd - 1] = -1;
    }
  }

  std::string path_;
  int saved_[2];
};

std::string base64(const std::string& bytes) {
  static constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t j) { return j < bytes.size() ? static_cast<unsigned char>(bytes[j]) : 0U; };
    const unsigned triple = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (unsigned j = 0; j < 4; ++j) text += j > bytes.size() - i ? '=' : kDigits[triple >> (18U - 6U * j) & 63U];
  }
  return text;
}

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(&bytes[0], values.data(), bytes.size());
  return bytes;
}

/// Length in front, as VTK wants it without header_type: 32 bits.
std::string with_length(const std::string& bytes) {
  return bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(bytes.size())}) + bytes;
}

const std::string kImage =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
    "<ImageData WholeExtent=\"0 1 0 1 0 2\" Origin=\"1 2 3\" Spacing=\"0.5 0.25 2\">\n<Piece Extent=\"0 1 0 1 0 2\">\n";
const std::string kEnd = "</Piece></ImageData></VTKFile>\n";
const std::string kAscii = "0 1 2 3 4 5 6 7 8 9 10 11";
const std::vector<float> kValues = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

std::string point_data(const std::string& arrays, const std::string& attributes = "") {
  return "<PointData" + attributes + ">" + arrays + "</PointData>";
}

std::string ascii_array(const std::string& type, const std::string& name, const std::string& values,
                        const std::string& more = "") {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\"" + more + ">" + values +
         "</DataArray>";
}

/// Reads a text as a VTI file; whatever is printed is a failure.
struct Outcome {
  Grid grid;
  std::string message;  // without the folder
  ErrorClass error_class = ErrorClass::kInternal;
};

Outcome attempt(const std::string& text, const GridOptions& options = {}) {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a.vti", text);
  CapturedOutput output(scratch.file("output"));
  Outcome outcome;
  try {
    outcome.grid = read_grid(path, options);
  } catch (const Error& error) {
    outcome.error_class = error.error_class();
    outcome.message = error.what();
    outcome.message.erase(0, outcome.message.find("a.vti"));
  }
  CHECK(output.text() == "");
  return outcome;
}

}  // namespace

TEST_CASE("read_vti: ascii values of any number type") {
  for (const char* type : {"Float32", "Float64", "Int32", "UInt8", "Int16", "Int64"}) {
    CAPTURE(type);
    const Outcome outcome = attempt(kImage + point_data(ascii_array(type, "phi", kAscii)) + kEnd);
    CHECK(outcome.message == "");
    CHECK(outcome.grid.values == kValues);
    CHECK(outcome.grid.lattice.size == std::array<int, 3>{2, 2, 3});
    CHECK(outcome.grid.lattice.origin == Vec3d{1, 2, 3});
    CHECK(outcome.grid.lattice.step[0] == Vec3d{0.5, 0, 0});
    CHECK(outcome.grid.lattice.step[2] == Vec3d{0, 0, 2});
    CHECK(outcome.grid.unit == PotentialUnit::kUnknown);
  }
}

TEST_CASE("read_vtp: text of type Float32 is a float, that of Float64 a double") {
  const ScratchFolder scratch;
  const std::string path = scratch.write(
      "a.vtp",
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"><PolyData>\n"
      "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><PointData>\n"
      "<DataArray type=\"Float64\" Name=\"wide\" format=\"ascii\">0.1 0.2 0.3</DataArray></PointData>\n"
      "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 0.1 0 0 0 0.1 "
      "0</DataArray></Points>\n"
      "<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>\n"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys>\n"
      "</Piece></PolyData></VTKFile>\n");
  const VtpContent read = read_vtp(path);
  REQUIRE(read.positions.size() == 3);
  CHECK(read.positions[1].x == static_cast<double>(0.1F));
  CHECK(find_array(read.point_arrays, "wide")->values[0] == 0.1);
}

TEST_CASE("read_vti: inline base64 and appended raw values") {
  const std::string base = "<DataArray type=\"Float32\" Name=\"phi\" format=\"binary\">" +
                           base64(with_length(bytes_of(kValues))) + "</DataArray>";
  CHECK(attempt(kImage + point_data(base) + kEnd).grid.values == kValues);

  const std::vector<double> doubles(kValues.begin(), kValues.end());
  const std::string array = "<DataArray type=\"Float64\" Name=\"phi\" format=\"appended\" offset=\"0\"/>";
  const std::string head = kImage + point_data(array) + "</Piece></ImageData>\n<AppendedData encoding=\"raw\">\n_";
  const std::string raw = head + with_length(bytes_of(doubles)) + "\n</AppendedData></VTKFile>\n";
  CHECK(attempt(raw).grid.values == kValues);

  // Cut within the values: VTK alone would fill up with zeros or rubbish.
  const Outcome cut = attempt(head + with_length(bytes_of(doubles)).substr(0, 40));
  CHECK(cut.error_class == ErrorClass::kFormat);
  CHECK(cut.message == "a.vti: the VTI file is cut short: it does not end with </VTKFile>; write or fetch it again");
  const Outcome hole = attempt(head + with_length(bytes_of(doubles)).substr(0, 40) + "\n</AppendedData></VTKFile>\n");
  CHECK(hole.error_class == ErrorClass::kFormat);
}

TEST_CASE("read_vti: direction matrix and an extent that starts elsewhere") {
  std::string text = kImage + point_data(ascii_array("Float32", "phi", kAscii)) + kEnd;
  text = replaced(text, "Spacing=", "Direction=\"0 -1 0 1 0 0 0 0 1\" Spacing=");
  const Grid turned = attempt(text).grid;
  CHECK(turned.lattice.step[0] == Vec3d{0, 0.5, 0});
  CHECK(turned.lattice.step[1] == Vec3d{-0.25, 0, 0});
  text = replaced(replaced(text, "WholeExtent=\"0 1 0 1 0 2\"", "WholeExtent=\"4 5 0 1 -1 1\""),
                  "Piece Extent=\"0 1 0 1 0 2\"", "Piece Extent=\"4 5 0 1 -1 1\"");
  const Grid shifted = attempt(text).grid;
  CHECK(shifted.lattice.origin == Vec3d{1, 4, 1});
  CHECK(shifted.values == kValues);
}

TEST_CASE("read_vti: arrays by name, by being the scalars, by being the only one") {
  const std::string two = ascii_array("Float32", "a", kAscii) + ascii_array("Float32", "b", "1 1 1 1 1 1 1 1 1 1 1 2");
  CHECK(attempt(kImage + point_data(two) + kEnd, {"b", ""}).grid.values.back() == 2);
  CHECK(attempt(kImage + point_data(two, " Scalars=\"b\"") + kEnd).grid.values.back() == 2);
  CHECK(attempt(kImage + point_data(two, " Scalars=\"b\"") + kEnd, {"a", ""}).grid.values == kValues);
  const Outcome unclear = attempt(kImage + point_data(two) + kEnd);
  CHECK(unclear.error_class == ErrorClass::kInput);
  CHECK(unclear.message == "a.vti: no point array is marked as scalars; choose one by name (point arrays: 'a', 'b')");
  const Outcome absent = attempt(kImage + point_data(two) + kEnd, {"c", ""});
  CHECK(absent.message == "a.vti: has no point array 'c'; it has 'a', 'b'");
  CHECK(attempt(kImage + kEnd).message == "a.vti: has no point arrays; save the map as point data");
  const Outcome vectors = attempt(
      kImage + point_data(ascii_array("Float32", "v", kAscii + " " + kAscii, " NumberOfComponents=\"2\"")) + kEnd,
      {"v", ""});
  CHECK(vectors.message == "a.vti: point array 'v' has 2 components; one number a point was expected");
}

TEST_CASE("read_vti: an array's name that is of another quantity than a potential is kept") {
  const auto title = [](const std::string& name) {
    return attempt(kImage + point_data(ascii_array("Float32", name, kAscii)) + kEnd).grid.contradicting_title;
  };
  CHECK(title("charge_density") == "charge_density");
  CHECK(title("potential").empty());
  CHECK(title("a").empty());
}

TEST_CASE("list_vti_scalars: names of arrays with one number a point, in file order, whatever their values") {
  const ScratchFolder scratch;
  const std::string scalar_b = ascii_array("Float32", "b", kAscii);
  const std::string vectors = ascii_array("Float32", "v", kAscii + " " + kAscii, " NumberOfComponents=\"2\"");
  const std::string damaged_a = ascii_array("Float64", "a", "nan");
  const std::string good = kImage + point_data(scalar_b + vectors + damaged_a) + kEnd;
  CHECK(list_vti_scalars(VtkXmlFile(scratch.write("a.vti", good), kImageData)) == std::vector<std::string>{"b", "a"});
  CHECK(list_vti_scalars(VtkXmlFile(scratch.write("b.vti", kImage + kEnd), kImageData)).empty());

  CapturedOutput output(scratch.file("output"));
  const std::string cut = scratch.write("c.vti", good.substr(0, good.size() - 20));
  CHECK(message_of([&] { list_vti_scalars(VtkXmlFile(cut, kImageData)); }).find("c.vti: the VTI file is cut short") !=
        std::string::npos);
  const std::string broken = scratch.write("d.vti", replaced(good, "</PointData>", "</PointDatum>"));
  CHECK(message_of([&] {
          list_vti_scalars(VtkXmlFile(broken, kImageData));
        }).find("d.vti:5: damaged XML: <PointData> of line 5 ends with </PointDatum>") != std::string::npos);
  CHECK(message_of([&] { list_vti_scalars(VtkXmlFile(scratch.file("absent.vti"), kImageData)); }).find("absent.vti") !=
        std::string::npos);
  CHECK(output.text() == "");
}

TEST_CASE("read_vti: damaged files are refused in silence") {
  const std::string good = kImage + point_data(ascii_array("Float32", "phi", kAscii)) + kEnd;
  const std::string broken_xml = replaced(good, "</PointData>", "</PointDatum>");
  for (const std::string& text :
       {broken_xml, good.substr(0, good.size() / 2), replaced(good, " 10 11", ""), replaced(good, " 11", " x"),
        replaced(good, "Piece Extent=\"0 1 0 1 0 2\"", "Piece Extent=\"0 1 0 1 0 1\""),
        replaced(good, "</VTKFile>", "</VTKFile>\n<VTKFile>")}) {
    CAPTURE(text);
    const Outcome outcome = attempt(text);
    CHECK(outcome.error_class == ErrorClass::kFormat);
    CHECK(outcome.message.find('\n') == std::string::npos);
    CHECK(outcome.message.find("a.vti:") == 0);
  }
}

TEST_CASE("read_vti: bad values and sizes") {
  const std::string good = kImage + point_data(ascii_array("Float64", "phi", kAscii)) + kEnd;
  CHECK(attempt(replaced(good, " 7 ", " nan ")).error_class == ErrorClass::kFormat);
  CHECK(attempt(replaced(good, " 7 ", " 1e300 ")).message.find("a.vti: value 8 is ") == 0);
  CHECK(attempt(replaced(good, "WholeExtent=\"0 1 0 1 0 2\"", "WholeExtent=\"0 1 0 1 0 0\"")).message ==
        "a.vti:3: the grid has 2 x 2 x 1 points; at least 2 along each axis were expected");
  CHECK(attempt(replaced(good, "WholeExtent=\"0 1 0 1 0 2\"", "WholeExtent=\"0 999 0 999 0 999\""))
            .message.find("a.vti: the header promises 1000000000 values, but only ") == 0);
  CHECK(attempt(replaced(good, "WholeExtent=\"0 1 0 1 0 2\"", "WholeExtent=\"0 99999 0 99999 0 99999\""))
            .message.find("a.vti:3: the grid has 100000 x 100000 x 100000 points; at most 2^31 - 1") == 0);
  CHECK(attempt(replaced(good, "Spacing=\"0.5 0.25 2\"", "Spacing=\"0.5 0 2\"")).message ==
        "a.vti:3: a grid step is zero; the three axes must have a length");
}

TEST_CASE("read_vti: pieces that cover the extent, and such that do not") {
  const auto piece = [](const std::string& extent, const std::string& values) {
    return "<Piece Extent=\"" + extent + "\">" + point_data(ascii_array("Float32", "phi", values)) + "</Piece>";
  };
  const std::string head = replaced(kImage, "<Piece Extent=\"0 1 0 1 0 2\">\n", "");
  const std::string end = "</ImageData></VTKFile>\n";
  const std::string low = piece("0 1 0 1 0 1", "0 1 2 3 4 5 6 7"), high = piece("0 1 0 1 1 2", "4 5 6 7 8 9 10 11");
  CHECK(attempt(head + low + high + end).grid.values == kValues);
  CHECK(attempt(head + high + low + end).grid.values == kValues);
  CHECK(attempt(head + low + end).message ==
        "a.vti: the pieces of the VTI file have 1 cells, but WholeExtent has 2; they must cover it exactly");
  CHECK(attempt(head + low + low + end).message.find("a.vti:3: the pieces of the VTI file overlap and leave a gap") ==
        0);
  CHECK(attempt(head + low + piece("0 1 0 1 2 3", "4 5 6 7 8 9 10 11") + end)
            .message.find("the extent '0 1 0 1 2 3' of a piece is no part of WholeExtent") != std::string::npos);
  const std::string other = replaced(high, "phi", "psi");
  CHECK(attempt(head + low + other + end).message.find("a piece has no point array 'phi'") != std::string::npos);
}

TEST_CASE("read_vti: what the head lacks is not guessed") {
  const std::string good = kImage + point_data(ascii_array("Float32", "phi", kAscii)) + kEnd;
  const auto message = [&](const std::string& what, const std::string& by) {
    return attempt(replaced(good, what, by)).message;
  };
  CHECK(message(" Spacing=\"0.5 0.25 2\"", "").find("a.vti:3: <ImageData> has no attribute Spacing") == 0);
  CHECK(message(" Origin=\"1 2 3\"", "").find("a.vti:3: <ImageData> has no attribute Origin") == 0);
  CHECK(message("Origin=\"1 2 3\"", "Origin=\"1 2 3\" Direction=\"1 0 0\"")
            .find("a.vti:3: Direction is '1 0 0', but 9") == 0);
  CHECK(message("LittleEndian", "Middle").find("a.vti:2: byte_order is 'Middle'") == 0);
  CHECK(message(" version=\"0.1\"", " version=\"0.1\" compressor=\"vtkLZ4DataCompressor\"")
            .find("a.vti: is compressed by 'vtkLZ4DataCompressor', and only vtkZLibDataCompressor can be read") == 0);
  CHECK(message("\"ImageData\"", "\"ImageData\" type=\"ImageData\"")
            .find("a.vti:2: damaged XML: <VTKFile> has two attributes type") == 0);
  CHECK(message(" 7 ", " 7.5 8 ").find("a.vti:5: array 'phi' has more than the 12 values") == 0);
  CHECK(attempt(kImage + point_data(ascii_array("UInt8", "phi", replaced(kAscii, " 7 ", " 300 "))) + kEnd)
            .message.find("a.vti:5: value 8 of array 'phi' is no UInt8") == 0);
}

TEST_CASE("read_vti: a compressed map from elsewhere") {
  const auto path = real_input("map_vti/hydrogen.vti");
  if (!path) return;
  const Grid grid = read_grid(*path);
  CHECK(grid.lattice.size == std::array<int, 3>{64, 64, 64});
  CHECK(grid.lattice.step[1] == Vec3d{0, 1, 0});
  // python3, base64 and zlib by hand: 262144 floats, sum 4856.008970333924, and at (20, 31, 33), (33, 31, 20):
  CHECK(grid.values[20 + 64 * (31 + 64 * 33)] == 0.21766400337219238F);
  CHECK(grid.values[33 + 64 * (31 + 64 * 20)] == 0.9119439721107483F);
  CHECK(list_vti_scalars(VtkXmlFile(*path, kImageData)) == std::vector<std::string>{"probability_density"});
  double sum = 0;
  for (float v : grid.values) sum += static_cast<double>(v);
  CHECK(sum == doctest::Approx(4856.008970333924).epsilon(1e-12));
  std::string text = read_file(*path);
  CHECK(attempt(text.substr(0, 200000)).error_class == ErrorClass::kFormat);
  // Rubbish within the compressed values.
  std::string corrupt = text;
  for (std::size_t i = 150000; i < 150400; ++i) corrupt[i] = 'A';
  CHECK(attempt(corrupt).error_class == ErrorClass::kFormat);
}
