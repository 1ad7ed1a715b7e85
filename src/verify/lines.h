// lines.h: collects recorded and recomputed numbers.
#pragma once

#include <string>

#include "verify/result_record.h"
#include "verify/verify.h"

namespace espdiff {

class Lines {
 public:
  Lines(const ResultRecord& record, Verification& result) : record_(record), result_(result) {}

  /// A number of OUT.json. One that is absent or null there differs, unless what was recomputed is no number either.
  /// @param tolerance in its unit; at least the rounding of sums in single precision
  void add(const std::string& pointer, double recomputed, double tolerance);
  /// The sum of an object's numbers.
  void add_sum(const std::string& pointer, double recomputed, double tolerance);
  /// Something that should be zero.
  void add_deviation(const std::string& name, double largest, double tolerance);
  void leave_out(const std::string& name, const std::string& why);

 private:
  const ResultRecord& record_;
  Verification& result_;
};

}  // namespace espdiff
