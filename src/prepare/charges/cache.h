// cache.h: outputs of PDB2PQR kept by the content that they were made from.
#pragma once

#include <optional>
#include <string>

namespace espdiff {

/// The folder $XDG_CACHE_HOME/espdiff/prepare, or ~/.cache/espdiff/prepare; empty where neither is known.
std::string cache_folder();

/// An output that was kept under a key (a SHA-256); nothing where there is none, or it is damaged.
std::optional<std::string> find_in_cache(const std::string& key);

/// Keeps an output. The oldest ones are deleted beyond 500. A cache that cannot be written is passed over in silence:
/// the result does not depend on it.
void keep_in_cache(const std::string& key, const std::string& output);

}  // namespace espdiff
