// plain_numbers.h: numbers as in the locale "C", whatever the program's is.
#pragma once

namespace espdiff {

/// While it lives, the C library prints and reads numbers with a point, in the calling thread alone.
class PlainNumbers {
 public:
  PlainNumbers();
  ~PlainNumbers();
  PlainNumbers(const PlainNumbers&) = delete;
  PlainNumbers& operator=(const PlainNumbers&) = delete;

 private:
  void* before_;
};

}  // namespace espdiff
