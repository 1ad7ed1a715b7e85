// buffer.h: an array on the device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "cuda/device/launch.h"
#include "cuda/device/memory.h"

namespace espdiff::ESPDIFF_BACKEND {

template <typename T>
struct FillWith {
  T* to;
  T value;
  ESPDIFF_HD void operator()(std::size_t i) const { to[i] = value; }
};

/// A vector on the device. New elements are uninitialized unless a value is given, because stages overwrite them. Raw
/// pointers are for kernels; the host reads with [], back() and to_host(), which wait for pending work.
template <typename T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>, "elements are copied as bytes");

 public:
  Buffer() = default;
  explicit Buffer(std::size_t n) { resize(n); }
  Buffer(std::size_t n, const T& value) { assign(n, value); }
  /// Copies the host's elements [first, last).
  Buffer(const T* first, const T* last) {
    resize(static_cast<std::size_t>(last - first));
    copy_to_device(data(), first, size_ * sizeof(T));
  }
  Buffer(const Buffer& other) { *this = other; }
  Buffer& operator=(const Buffer& other) {
    if (this == &other) return *this;
    discard_and_resize(other.size_);
    copy_on_device(data(), other.data(), size_ * sizeof(T));
    return *this;
  }
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    Buffer(std::move(other)).swap(*this);
    return *this;
  }

  void swap(Buffer& other) noexcept {
    block_.swap(other.block_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return static_cast<T*>(block_.get()); }
  const T* data() const { return static_cast<const T*>(block_.get()); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }

  /// Keeps the existing elements.
  void resize(std::size_t n) {
    if (n > capacity_) {
      MemoryBlock larger(n * sizeof(T));
      copy_on_device(larger.get(), block_.get(), size_ * sizeof(T));
      block_ = std::move(larger);
      capacity_ = n;
    }
    size_ = n;
  }
  void resize(std::size_t n, const T& value) {
    const std::size_t before = std::min(size_, n);
    resize(n);
    fill(before, value);
  }
  void assign(std::size_t n, const T& value) {
    discard_and_resize(n);
    fill(0, value);
  }

  /// For the host; waits for pending work.
  T operator[](std::size_t i) const {
    T value;
    copy_to_host(&value, data() + i, sizeof(T));
    return value;
  }
  T back() const { return (*this)[size_ - 1]; }

 private:
  void fill(std::size_t from, const T& value) { for_each_index(size_ - from, FillWith<T>{data() + from, value}); }
  void discard_and_resize(std::size_t n) {
    size_ = 0;
    resize(n);
  }

  MemoryBlock block_;
  std::size_t size_ = 0, capacity_ = 0;
};

template <typename T>
T* raw(Buffer<T>& buffer) {
  return buffer.data();
}
template <typename T>
const T* raw(const Buffer<T>& buffer) {
  return buffer.data();
}

template <typename T>
Buffer<T> to_device(const std::vector<T>& host) {
  return Buffer<T>(host.data(), host.data() + host.size());
}
template <typename T>
std::vector<T> to_host(const Buffer<T>& buffer) {
  std::vector<T> host(buffer.size());
  copy_to_host(host.data(), buffer.data(), buffer.size() * sizeof(T));
  return host;
}

/// Adds the read of an element.
template <typename T>
void read_element(HostReads& reads, T& to, const Buffer<T>& buffer, std::size_t i) {
  reads.add(&to, buffer.data() + i, sizeof(T));
}
/// Adds the read of the elements [first, first + n).
template <typename T>
void read_elements(HostReads& reads, std::vector<T>& to, const Buffer<T>& buffer, std::size_t first, std::size_t n) {
  to.resize(n);
  reads.add(to.data(), buffer.data() + first, n * sizeof(T));
}

}  // namespace espdiff::ESPDIFF_BACKEND
