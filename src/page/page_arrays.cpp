// page_arrays.cpp: numbers for a page in a browser: steps of at most 16 bits, deflated, as base64.
#include "page/page_arrays.h"

#if defined(ESPDIFF_HAVE_ZLIB)
#include <zlib.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/progress.h"
#include "io/files/base64.h"

namespace espdiff {
namespace {

constexpr std::uint32_t kNoValue = 65535;

void append_bits(std::string& bytes, std::uint32_t value, int n_bytes) {
  for (int i = 0; i < n_bytes; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xffU);
}

/// The lowest bytes of all numbers, then the next ones.
void append_planes(std::string& bytes, const std::vector<std::uint32_t>& values, int n_bytes) {
  for (int plane = 0; plane < n_bytes; ++plane) {
    for (const std::uint32_t value : values) bytes += static_cast<char>((value >> (8 * plane)) & 0xffU);
  }
}

#if defined(ESPDIFF_HAVE_ZLIB)
/// Ends a compression that succeeded, failed or was cancelled.
struct Deflation {
  z_stream stream{};
  ~Deflation() { deflateEnd(&stream); }
};
#endif

/// In parts, since the smallest form of millions of numbers takes seconds. @throws Cancelled
std::string deflated(const std::string& bytes) {
#if defined(ESPDIFF_HAVE_ZLIB)
  constexpr std::size_t kPart = 1U << 17U;
  Deflation deflation;
  z_stream& stream = deflation.stream;
  bool is_well = deflateInit(&stream, Z_BEST_COMPRESSION) == Z_OK;
  std::string out(compressBound(bytes.size()), '\0');
  for (std::size_t at = 0; is_well; at += kPart) {
    CancelRequest().check();
    const bool is_last = at + kPart >= bytes.size();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data())) + at;
    stream.avail_in = static_cast<uInt>(std::min(kPart, bytes.size() - at));
    stream.next_out = reinterpret_cast<Bytef*>(out.data()) + stream.total_out;
    stream.avail_out = static_cast<uInt>(out.size() - stream.total_out);
    const int code = deflate(&stream, is_last ? Z_FINISH : Z_NO_FLUSH);
    is_well = code == (is_last ? Z_STREAM_END : Z_OK);
    if (is_last) break;
  }
  if (!is_well) throw Error(ErrorClass::kInternal, "the page's arrays could not be compressed");
  out.resize(stream.total_out);
  return out;
#else
  return bytes;
#endif
}

}  // namespace

bool PageArrays::is_deflated() {
#if defined(ESPDIFF_HAVE_ZLIB)
  return true;
#else
  return false;
#endif
}

std::size_t PageArrays::begin(std::size_t alignment) {
  while (bytes_.size() % alignment != 0) bytes_ += '\0';
  return bytes_.size();
}

nlohmann::ordered_json PageArrays::add_numbers(const std::vector<double>& values, int n_steps, int stride) {
  CancelRequest().check();
  double low = 0, high = 0;
  bool is_first = true;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = is_first ? value : std::min(low, value);
    high = is_first ? value : std::max(high, value);
    is_first = false;
  }
  const double scale = high > low ? n_steps / (high - low) : 0;
  std::vector<std::uint32_t> differences, before(static_cast<std::size_t>(stride), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::uint32_t& last = before[i % before.size()];
    const std::uint32_t step =
        std::isfinite(values[i]) ? static_cast<std::uint32_t>(std::lround((values[i] - low) * scale)) : kNoValue;
    differences.push_back(step - last);
    last = step;
  }
  const std::size_t offset = bytes_.size();
  append_planes(bytes_, differences, 2);
  return {{"offset", offset}, {"n", values.size()}, {"min", low},
          {"max", high},      {"steps", n_steps},   {"stride", stride}};
}

nlohmann::ordered_json PageArrays::add_singles(const std::vector<double>& values) {
  const std::size_t offset = begin(4);
  for (const double value : values) {
    const auto single = static_cast<float>(value);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &single, sizeof bits);
    append_bits(bytes_, bits, 4);
  }
  return {{"offset", offset}, {"n", values.size()}, {"single", true}};
}

nlohmann::ordered_json PageArrays::add_triangles(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> differences;
  std::uint32_t before = 0;
  for (const Triangle& triangle : triangles) {
    for (const auto corner : triangle) {
      differences.push_back(static_cast<std::uint32_t>(corner) - before);
      before = static_cast<std::uint32_t>(corner);
    }
  }
  const std::size_t offset = bytes_.size();
  append_planes(bytes_, differences, 4);
  return {{"offset", offset}, {"n", triangles.size()}};
}

nlohmann::ordered_json PageArrays::add_integers(const std::vector<std::int32_t>& values) {
  const std::size_t offset = begin(4);
  for (const std::int32_t value : values) append_bits(bytes_, static_cast<std::uint32_t>(value), 4);
  return {{"offset", offset}, {"n", values.size()}};
}

std::string PageArrays::base64() const { return packed(bytes_); }

std::string PageArrays::packed(const std::string& bytes) {
  CancelRequest().check();
  return base64_of(deflated(bytes));
}

}  // namespace espdiff
