// Checkpoints: the state that determines the following steps, as bytes. A class lists its fields once, for writing and
// reading:
//     template <class Archive> void archive(Archive& ar) { ar(kick_, factor_, count_); }
// Kinds of fields: numbers, enumerations, strings, std::vector, std::array, C arrays, std::optional, Vector of either
// kind, classes with archive(), and empty classes, which write nothing. All functions are cold: compiled for size. Data
// that follow from a field, e.g. a pointer into a table, are set again if `Archive::reading` is true. Bytes are in the
// order of the machine: a checkpoint is not an exchange format. Equal values give equal bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hamflow/core/error.hpp"
#include "hamflow/core/vector.hpp"

namespace hamflow {

class Writer;
class Reader;

/// How a number type is stored in an archive. Specialise it for types that are not plain bytes:
///     template <> struct ArchivedNumber<Big> : ArchivedText<Big> {};
/// or with static void write(Writer&, const T&) and static void read(Reader&, T&) of its own.
template <class T>
struct ArchivedNumber;

namespace detail {
/// The number of bytes that hold the value. The 80-bit long double has 6 more bytes, with undefined content.
template <class T>
constexpr std::size_t significant_bytes() {
  return std::is_same_v<T, long double> && std::numeric_limits<long double>::digits == 64 ? 10 : sizeof(T);
}
template <class T>
concept PlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T> ||
    (!std::is_array_v<T> && std::is_trivially_copyable_v<T> && std::numeric_limits<T>::is_specialized);
template <class T, class Archive>
concept HasArchive = requires(T& object, Archive& ar) {
  object.archive(ar);
};
template <class T>
struct IsVector : std::false_type {};
template <class R, std::size_t N>
struct IsVector<Vector<R, N>> : std::true_type {};
template <class T>
struct IsDynamicMatrix : std::false_type {};
template <class R>
struct IsDynamicMatrix<Vector<Vector<R, dynamic>, dynamic>> : std::true_type {};
template <class T>
struct IsStdVector : std::false_type {};
template <class T>
struct IsStdVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsStdArray : std::false_type {};
template <class T, std::size_t N>
struct IsStdArray<std::array<T, N>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
concept FixedSequence = IsStdArray<T>::value || std::is_array_v<T>;
}  // namespace detail

/// Turns fields into bytes.
class Writer {
 public:
  static constexpr bool reading = false;

  template <class... Fields>
  [[gnu::cold]] void operator()(const Fields&... fields) {
    (put(fields), ...);
  }
  [[gnu::cold, gnu::noinline]] void raw(const void* from, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  [[gnu::cold, gnu::noinline]] void count(std::size_t size) { put(static_cast<std::uint64_t>(size)); }
  template <class T>
  [[gnu::cold]] void put(const T& x) {
    if constexpr (detail::HasArchive<T, Writer>) {
      const_cast<T&>(x).archive(*this);  // NOLINT: one list of fields serves both directions; a Writer changes no field
    } else if constexpr (requires { ArchivedNumber<T>::write(*this, x); }) {
      ArchivedNumber<T>::write(*this, x);
    } else if constexpr (detail::PlainNumber<T>) {
      raw(&x, detail::significant_bytes<T>());
    } else if constexpr (std::is_same_v<T, std::string>) {
      count(x.size());
      raw(x.data(), x.size());
    } else if constexpr (detail::IsOptional<T>::value) {
      put(x.has_value());
      if (x) put(*x);
    } else if constexpr (detail::IsDynamicMatrix<T>::value) {
      count(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = 0; j < x.size(); ++j) put(x[i][j]);
      }
    } else if constexpr (detail::IsVector<T>::value || detail::IsStdVector<T>::value) {
      count(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) put(x[i]);
    } else if constexpr (detail::FixedSequence<T>) {
      for (const auto& entry : x) put(entry);
    } else {
      static_assert(std::is_empty_v<T>,
                    "hamflow: this type has fields but no archive(); list them, see detail/core/archive.hpp");
    }
  }

  std::vector<std::byte> bytes_;
};

/// Turns bytes back into fields. @throws Error if there are too few bytes or they do not fit the type of the field
class Reader {
 public:
  static constexpr bool reading = true;

  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class... Fields>
  [[gnu::cold]] void operator()(Fields&... fields) {
    (get(fields), ...);
  }
  [[gnu::cold, gnu::noinline]] void raw(void* to, std::size_t size) {
    if (size > bytes_.size()) throw Error("the saved bytes end too early");
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  std::size_t left() const { return bytes_.size(); }
  /// @throws Error if bytes are left over
  void finish() const {
    if (!bytes_.empty()) throw Error("there are more saved bytes than expected");
  }

 private:
  [[gnu::cold, gnu::noinline]] std::size_t count() {
    std::uint64_t size = 0;
    get(size);
    if (size > left()) throw Error("the saved bytes end too early");  // an entry has at least one byte
    return static_cast<std::size_t>(size);
  }
  template <class T>
  [[gnu::cold]] void get(T& x) {
    if constexpr (detail::HasArchive<T, Reader>) {
      x.archive(*this);
    } else if constexpr (requires { ArchivedNumber<T>::read(*this, x); }) {
      ArchivedNumber<T>::read(*this, x);
    } else if constexpr (std::is_same_v<T, bool>) {
      unsigned char byte = 0;
      get(byte);
      if (byte > 1) throw Error("the saved bytes hold an invalid truth value");
      x = byte == 1;
    } else if constexpr (detail::PlainNumber<T>) {
      raw(&x, detail::significant_bytes<T>());
    } else if constexpr (std::is_same_v<T, std::string>) {
      x.resize(count());
      raw(x.data(), x.size());
    } else if constexpr (detail::IsOptional<T>::value) {
      bool is_set = false;
      get(is_set);
      x.reset();
      if (is_set) get(x.emplace());
    } else if constexpr (detail::IsDynamicMatrix<T>::value) {
      const std::size_t size = count();
      if (size > 0 && size > left() / size) throw Error("the saved bytes end too early");
      x = T(size);
      for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) get(x[i][j]);
      }
    } else if constexpr (detail::IsVector<T>::value) {
      const std::size_t size = count();
      if constexpr (requires { T::size(); }) {
        if (size != T::size()) throw Error("the saved bytes hold a vector of another size");
      } else {
        x = T(size);
      }
      for (std::size_t i = 0; i < size; ++i) get(x[i]);
    } else if constexpr (detail::IsStdVector<T>::value) {
      x.assign(count(), typename T::value_type{});
      for (auto& entry : x) get(entry);
    } else if constexpr (detail::FixedSequence<T>) {
      for (auto& entry : x) get(entry);
    } else {
      static_assert(std::is_empty_v<T>,
                    "hamflow: this type has fields but no archive(); list them, see detail/core/archive.hpp");
    }
  }

  std::span<const std::byte> bytes_;
};

/// Archives numbers without a fixed size as text that holds them exactly. exact_text(x) and from_exact_text(text, x)
/// are found by argument-dependent look-up.
template <class T>
struct ArchivedText {
  static void write(Writer& ar, const T& x) { ar(exact_text(x)); }
  static void read(Reader& ar, T& x) {
    std::string text;
    ar(text);
    from_exact_text(text, x);
  }
};

}  // namespace hamflow
