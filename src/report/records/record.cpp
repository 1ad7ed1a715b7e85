// record.cpp: values of a record by their places.
#include "report/records/record.h"

#include <algorithm>

#include "base/not_a_number.h"
#include "base/text/printable.h"
#include "base/units.h"
#include "report/records/metrics.h"

namespace espdiff {

const Record::Json& Record::at(const std::string& pointer) const {
  static const Json none;
  const Json::json_pointer place(pointer);
  return json_.contains(place) ? json_.at(place) : none;
}

double Record::number(const std::string& pointer) const {
  const Json& value = at(pointer);
  return value.is_number() ? value.get<double>() : kNaN;
}

std::size_t Record::count(const std::string& pointer) const {
  const Json& value = at(pointer);
  return value.is_number_unsigned() || (value.is_number_integer() && value.get<long long>() >= 0)
             ? value.get<std::size_t>()
             : 0;
}

bool Record::flag(const std::string& pointer) const {
  const Json& value = at(pointer);
  return value.is_boolean() && value.get<bool>();
}

std::string Record::text(const std::string& pointer) const {
  const Json& value = at(pointer);
  return value.is_string() ? printable(value.get<std::string>()) : std::string();
}

std::vector<std::string> Record::texts(const std::string& pointer) const {
  std::vector<std::string> all;
  const Json& list = at(pointer);
  if (!list.is_array()) return all;
  for (const Json& item : list) {
    if (item.is_string()) all.push_back(Record(item).text(""));
    if (item.is_object()) all.push_back(Record(item).text("/text"));
  }
  return all;
}

double Record::value_of(const Metric& metric) const { return number(metric.json_pointer()); }

double Record::value_over_all_triangles(const Metric& metric) const {
  return number(std::string("/metrics_all_triangles/") + metric.name);
}

bool Record::is_unchecked(const Metric& metric) const {
  const std::string pointer = metric.json_pointer();
  const std::vector<std::string> names = texts("/certificate/not_checked");
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return pointer.rfind("/certificate/" + name + "/", 0) == 0; });
}

std::string Record::potential_unit() const { return without_vacuum(text("/potential_unit")); }

}  // namespace espdiff
