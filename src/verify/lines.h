// lines.h: collects recorded and recomputed numbers, and what of a result is not recomputed.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "verify/result_record.h"
#include "verify/verify.h"

namespace espdiff {

/// Names are JSON pointers in OUT.json, without the first slash, or FILE/NAME of an array or column, such as
/// OUT.vtp/slip. What no line covers is named in the end, so that nothing of a result is passed over in silence.
class Lines {
 public:
  Lines(const ResultRecord& record, Verification& result);

  /// A number of OUT.json. One that is absent or null there differs, unless what was recomputed is no number either.
  /// @param tolerance in its unit; at least the rounding of sums in single precision
  void add(const std::string& pointer, double recomputed, double tolerance);
  /// The sum of an object's numbers.
  void add_sum(const std::string& pointer, double recomputed, double tolerance);
  /// Something that should be zero.
  void add_deviation(const std::string& name, double largest, double tolerance);
  /// A text of OUT.json that another file has as well.
  void add_text(const std::string& pointer, const std::string& elsewhere, const std::string& where);

  /// An array or a column that there is.
  void has(const std::string& name) { there_.push_back(name); }
  /// What a line depends on, with all that is in it: it would differ if this were wrong.
  void cover(const std::string& name) { covered_.insert(name); }
  /// Why what is at this place, or in it, is not recomputed.
  void explain(const std::string& name, const std::string& why) { reasons_[name] = why; }
  /// Lists all that is not covered, by reason.
  void name_the_rest();

 private:
  bool is_covered(const std::string& name) const;
  std::string reason_of(const std::string& name) const;

  const ResultRecord& record_;
  Verification& result_;
  std::vector<std::string> there_;
  std::set<std::string> covered_;
  std::map<std::string, std::string> reasons_;
};

}  // namespace espdiff
