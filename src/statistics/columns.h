// columns.h: values of replicates as columns: one time series for each vertex.
#pragma once

#include <cstddef>
#include <vector>

namespace espdiff {

/// Values of all frames of some replicates at the same vertices. They may be in a file: what reads them asks for a few
/// columns of one replicate at a time.
class Columns {
 public:
  virtual ~Columns() = default;
  virtual std::size_t n_columns() const = 0;
  virtual std::size_t n_replicates() const = 0;
  virtual std::size_t n_frames(std::size_t replicate) const = 0;
  /// @param values becomes [frame][column - begin]; NaN where a value is missing
  virtual void read(std::size_t replicate, std::size_t begin, std::size_t end, std::vector<float>& values) const = 0;
};

/// Columns in memory.
class ColumnsInMemory : public Columns {
 public:
  explicit ColumnsInMemory(std::size_t n_columns) : n_columns_(n_columns) {}
  /// @param values [frame][column]
  void add_replicate(std::vector<float> values) { replicates_.push_back(std::move(values)); }

  std::size_t n_columns() const override { return n_columns_; }
  std::size_t n_replicates() const override { return replicates_.size(); }
  std::size_t n_frames(std::size_t replicate) const override { return replicates_[replicate].size() / n_columns_; }
  void read(std::size_t replicate, std::size_t begin, std::size_t end, std::vector<float>& values) const override {
    values.clear();
    const std::vector<float>& all = replicates_[replicate];
    for (std::size_t row = 0; row < all.size(); row += n_columns_)
      values.insert(values.end(), all.begin() + static_cast<std::ptrdiff_t>(row + begin),
                    all.begin() + static_cast<std::ptrdiff_t>(row + end));
  }

 private:
  std::size_t n_columns_;
  std::vector<std::vector<float>> replicates_;
};

/// Bytes of values that are read at a time.
constexpr std::size_t kColumnBytes = std::size_t{32} << 20;

}  // namespace espdiff
