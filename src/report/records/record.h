// record.h: reads a result's record (OUT.json) by the places of its values.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace espdiff {

struct Metric;

/// A view of a comparison's record, or of a part of it that has the same places (a region, a patch). A value that is
/// missing, null or of another type reads as "none": NaN, 0, false or an empty text.
class Record {
 public:
  using Json = nlohmann::ordered_json;

  /// @param json must outlast the view
  explicit Record(const Json& json) : json_(json) {}

  /// The value at a JSON pointer; null if there is none.
  const Json& at(const std::string& pointer) const;
  bool has(const std::string& pointer) const { return !at(pointer).is_null(); }
  double number(const std::string& pointer) const;
  std::size_t count(const std::string& pointer) const;
  bool flag(const std::string& pointer) const;
  std::string text(const std::string& pointer) const;
  /// The texts of a list; of a list of objects those under "text".
  std::vector<std::string> texts(const std::string& pointer) const;
  /// The number of a metric over the trusted area, or of the whole.
  double value_of(const Metric& metric) const;
  /// Over all triangles with samples, trusted or not.
  double value_over_all_triangles(const Metric& metric) const;
  /// Whether the certificate says that this was not checked.
  bool is_unchecked(const Metric& metric) const;
  bool has_potential() const { return has("/potential_unit"); }
  /// The unit of the metrics' potentials: "kT/e" of "kT/e in vacuum"; empty if there are none.
  std::string potential_unit() const;

 private:
  const Json& json_;
};

}  // namespace espdiff
