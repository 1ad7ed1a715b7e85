// vector.h: 3- and 4-component vectors and rigid transforms, usable on host and device.
#pragma once

#include <cmath>
#include <cstdint>

/// Marks a function that both back ends compile: host code for g++, host and device code for nvcc.
#if defined(__CUDACC__)
#define ESPDIFF_HD __host__ __device__
#else
#define ESPDIFF_HD
#endif

namespace espdiff {

constexpr double kPi = 3.14159265358979323846;

/// A 3-vector; lengths are in Angstrom unless the declaration says otherwise.
template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  ESPDIFF_HD constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  ESPDIFF_HD constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }

  template <typename U>
  ESPDIFF_HD constexpr explicit operator Vec3<U>() const {
    return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
  }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <typename T>
ESPDIFF_HD constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
ESPDIFF_HD constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename T>
ESPDIFF_HD constexpr Vec3<T> operator*(T s, Vec3<T> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <typename T>
ESPDIFF_HD constexpr Vec3<T>& operator+=(Vec3<T>& a, Vec3<T> b) {
  a = a + b;
  return a;
}
template <typename T>
ESPDIFF_HD constexpr bool operator==(Vec3<T> a, Vec3<T> b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
template <typename T>
ESPDIFF_HD constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
ESPDIFF_HD constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
ESPDIFF_HD T norm(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}

/// A 3-vector with a fourth component, aligned so that one load fetches it: a vertex, or a gradient with its value.
struct alignas(16) Vec4f {
  float x{}, y{}, z{}, w{};

  ESPDIFF_HD constexpr Vec3f xyz() const { return {x, y, z}; }
};

ESPDIFF_HD constexpr Vec4f operator+(Vec4f a, Vec4f b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
ESPDIFF_HD constexpr Vec4f operator-(Vec4f a, Vec4f b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
ESPDIFF_HD constexpr Vec4f operator*(float s, Vec4f a) { return {s * a.x, s * a.y, s * a.z, s * a.w}; }
ESPDIFF_HD constexpr Vec4f make_vec4(Vec3f a, float w) { return {a.x, a.y, a.z, w}; }

/// x -> rotation * x + translation. `rotation` is row-major and orthonormal with determinant +1; `translation` in
/// Angstrom.
struct RigidTransform {
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3d translation{};

  ESPDIFF_HD constexpr Vec3d apply(Vec3d p) const { return rotate(p) + translation; }
  ESPDIFF_HD constexpr Vec3d rotate(Vec3d p) const {
    return {rotation[0] * p.x + rotation[1] * p.y + rotation[2] * p.z,
            rotation[3] * p.x + rotation[4] * p.y + rotation[5] * p.z,
            rotation[6] * p.x + rotation[7] * p.y + rotation[8] * p.z};
  }
};

}  // namespace espdiff
