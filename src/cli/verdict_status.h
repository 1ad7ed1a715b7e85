// verdict_status.h: the exit status of an answer.
#pragma once

#include "certificate/result.h"

namespace espdiff::cli {

constexpr int kNotTrustedStatus = 3;

/// 0 for an answer that can be trusted, otherwise kNotTrustedStatus; 0 always if `exit_zero` (`--exit-zero`) is set.
inline int verdict_status(const CompareResult& result, bool exit_zero) {
  return result.certificate.trustworthy || exit_zero ? 0 : kNotTrustedStatus;
}

}  // namespace espdiff::cli
