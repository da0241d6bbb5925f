// The data that a step passes to the next one, found by visiting the archive() of a state, a probe and a method. The
// recorded step has traces and the simulation has doubles, but both have the same fields in the same order.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "hamflow/detail/core/archive.hpp"
#include "hamflow/detail/core/tape.hpp"

namespace hamflow {

namespace detail {
template <class T>
struct IsTrace : std::false_type {};
template <class R>
struct IsTrace<Trace<R>> : std::true_type {};

/// Calls leaf(x) for every number that an archive would store.
template <class Leaf>
class ArchiveWalk {
 public:
  static constexpr bool reading = false;
  explicit ArchiveWalk(Leaf& leaf) : leaf_(leaf) {}
  template <class... Fields>
  void operator()(Fields&... fields) {
    (visit(const_cast<std::remove_const_t<Fields>&>(fields)), ...);  // NOLINT: one list of fields for both directions
  }

 private:
  template <class T>
  void visit(T& x) {
    if constexpr (IsTrace<T>::value || std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      leaf_(x);
    } else if constexpr (HasArchive<T, ArchiveWalk>) {
      x.archive(*this);
    } else if constexpr (IsVector<T>::value || IsStdVector<T>::value) {
      for (std::size_t i = 0; i < x.size(); ++i) visit(x[i]);
    } else if constexpr (FixedSequence<T>) {
      for (auto& entry : x) visit(entry);
    } else {
      static_assert(std::is_empty_v<T>, "hamflow: a step with a field of this type cannot be recorded");
    }
  }
  Leaf& leaf_;
};
}  // namespace detail

/// Calls leaf(x) for every number of the objects, in the order of their archives.
template <class Leaf, class... Objects>
void for_each_carried(Leaf&& leaf, Objects&... objects) {
  detail::ArchiveWalk<std::remove_reference_t<Leaf>> walk(leaf);
  walk(objects...);
}

/// How a number changes from step to step.
struct CarriedField {
  enum class Kind : std::uint8_t {
    carried,  // a value of the program
    kept,     // the same in every step: these bits
    counter   // grows by this number with every step
  };
  Kind kind;
  std::uint64_t bits = 0;
};

/// Returns the bits of a number that is not a trace.
template <class T>
std::uint64_t field_bits(const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    return std::bit_cast<std::uint64_t>(x);
  } else {
    static_assert(std::is_integral_v<T> || std::is_enum_v<T>, "hamflow: a field of this type cannot be recorded");
    return static_cast<std::uint64_t>(x);
  }
}

/// Reads the carried numbers of a simulation's objects. @return false if they differ from the recording: a kept number,
/// or the count
template <class... Objects>
bool gather(std::span<const CarriedField> fields, std::span<double> values, Objects&... objects) {
  std::size_t at = 0;
  std::size_t value = 0;
  bool fits = true;
  for_each_carried(
      [&]<class T>(T& x) {
        if (!fits || at == fields.size()) {
          fits = false;
          return;
        }
        const CarriedField& field = fields[at++];
        if (field.kind == CarriedField::Kind::carried) {
          if constexpr (std::is_same_v<T, double>) {
            values[value++] = x;
          } else {
            fits = false;
          }
        } else if (field.kind == CarriedField::Kind::kept) {
          fits = field_bits(x) == field.bits;
        }
      },
      objects...);
  return fits && at == fields.size();
}

/// Writes the carried numbers back after the given number of steps.
template <class... Objects>
void scatter(std::span<const CarriedField> fields, std::span<const double> values, std::int64_t steps,
             Objects&... objects) {
  std::size_t at = 0;
  std::size_t value = 0;
  for_each_carried(
      [&]<class T>(T& x) {
        const CarriedField& field = fields[at++];
        if (field.kind == CarriedField::Kind::carried) {
          if constexpr (std::is_same_v<T, double>) x = values[value++];
        } else if (field.kind == CarriedField::Kind::counter) {
          if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
            x += static_cast<T>(static_cast<std::int64_t>(field.bits) * steps);
          }
        }
      },
      objects...);
}

}  // namespace hamflow
