// result_record.h: OUT.json, read by someone who trusts nothing in it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace espdiff {

/// An input that OUT.json names.
struct VerifiedInput {
  std::string path;  ///< that exists: the recorded one, or the file of that name beside OUT.json
  std::string sha256;
  int model = 1;
  bool hetero = true, water = false;
  bool computed = false;  ///< a potential that is in no file
};

class ResultRecord {
 public:
  /// @param prefix OUT
  /// @throws IoError (absent), InputError (not the record of a comparison)
  explicit ResultRecord(const std::string& prefix);

  const std::string& path() const { return path_; }
  /// The number at a JSON pointer without its first slash; nullopt if there is none, or null.
  std::optional<double> number(const std::string& pointer) const;
  /// The same, or `fallback` if there is none. @throws InputError (out of range)
  double number_between(const std::string& pointer, double least, double most, double fallback) const;
  bool flag(const std::string& pointer) const;         ///< false if there is none
  std::string text(const std::string& pointer) const;  ///< empty if there is none
  /// Arrays of three whole numbers.
  /// @throws InputError (others)
  std::vector<std::vector<std::size_t>> triples(const std::string& pointer) const;
  /// Of the numbers in an object; NaN if there is none.
  double sum(const std::string& pointer) const;
  std::vector<double> numbers(const std::string& pointer) const;
  /// The number of entries of an array or object; 0 if there is none.
  std::size_t size(const std::string& pointer) const;
  /// Pointers of all that is neither an object nor an array, and of empty ones.
  std::vector<std::string> leaves() const;
  /// The place of an input in OUT.json, "inputs/0". @pre there is one
  std::string place_of_input(const std::string& role) const;
  std::optional<VerifiedInput> input(const std::string& role) const;

 private:
  const nlohmann::json* at(const std::string& pointer) const;

  std::string path_;
  std::shared_ptr<const nlohmann::json> json_;
};

}  // namespace espdiff
