// Maps the name of a pair law to its type.
#pragma once

#include <stdexcept>
#include <variant>

#include "hamflow/core/problem_info.hpp"

namespace hamflow::detail {

/// @tparam Laws a std::variant of laws; those with info() are built in
template <class Laws, std::size_t at = 0, class R>
Laws make_pair_law_of(const std::string& name, const Parameters<R>& given) {
  if constexpr (at < std::variant_size_v<Laws>) {
    using Law = std::variant_alternative_t<at, Laws>;
    if constexpr (requires { Law::info(); }) {
      if (Law::info().name == name) return Law(given);
    }
    return make_pair_law_of<Laws, at + 1>(name, given);
  } else {
    throw std::logic_error("hamflow: there is no pair law " + name);
  }
}

}  // namespace hamflow::detail
