// Functions of C++20's standard library that the libc++ of emscripten 3.1 lacks. Compiled into every unit by
// cmake/emscripten.cmake, and used by no other build.
#pragma once

#ifdef __cplusplus
#include <bit>
#include <charconv>
#include <compare>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

namespace std {
#ifndef __cpp_lib_bit_cast
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  return __builtin_bit_cast(To, from);
}
#endif

template <class C, class T, class A>
strong_ordering operator<=>(const basic_string<C, T, A>& a, const basic_string<C, T, A>& b) {
  return a.compare(b) <=> 0;
}
template <class T, class A>
auto operator<=>(const vector<T, A>& a, const vector<T, A>& b) -> decltype(a[0] <=> b[0]) {
  for (size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (const auto order = a[i] <=> b[i]; order != 0) return order;
  }
  return a.size() <=> b.size();
}

/// The nearest double. Like std::from_chars in the format `general`: neither a sign + nor leading spaces.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const char* at = first;
  if (at != last && *at == '-') ++at;
  if (at == last || !((*at >= '0' && *at <= '9') || *at == '.')) return {first, errc::invalid_argument};
  const char* end = at;
  while (end != last && ((*end >= '0' && *end <= '9') || *end == '.')) ++end;
  if (end != last && (*end == 'e' || *end == 'E')) {
    const char* digits = end + 1;
    if (digits != last && (*digits == '-' || *digits == '+')) ++digits;
    const char* const begin = digits;
    while (digits != last && *digits >= '0' && *digits <= '9') ++digits;
    if (digits != begin) end = digits;
  }
  const string text(first, end);
  char* behind = nullptr;
  const double read = strtod(text.c_str(), &behind);
  if (behind == text.c_str()) return {first, errc::invalid_argument};
  const char* const stop = first + (behind - text.c_str());
  if (read > __DBL_MAX__ || read < -__DBL_MAX__) return {stop, errc::result_out_of_range};
  value = read;
  return {stop, errc()};
}
/// In standard_library.cpp.
to_chars_result to_chars(char* first, char* last, double value);
}  // namespace std
#endif
