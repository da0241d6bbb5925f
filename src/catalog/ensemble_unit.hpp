// The blocks of lanes that the catalogue offers for one problem. The build makes one translation unit of it per
// problem, as of problem_unit.hpp; a problem that lanes cannot take has an entry that says so.
#pragma once

#include "hamflow/problems/support/fast_kernel.hpp"
#include "hamflow/run/ensemble_of.hpp"

namespace hamflow {

/// The blocks of one problem.
struct EnsembleEntry {
  std::string name;
  std::vector<std::pair<std::string, std::string>> variant;
  /// Null where there is none.
  std::unique_ptr<EnsembleBlock> (*make)(const AnySplitting& method, bool fast, LaneSet lanes) = nullptr;
};

template <template <class> class Family>
class EnsembleUnit {
  using P = Family<double>;
  template <class R>
  using Fast = FastKernel<Family<R>>;

 public:
  static EnsembleEntry entry() {
    const ProblemInfo info = P::info();
    if constexpr (LaneProblem<P>) {
      return {info.name, info.variant, make};
    } else {
      return {info.name, info.variant, nullptr};
    }
  }

 private:
  static constexpr bool has_fast_kernel = HasFastForce<P>;

  template <template <class> class F, class Set>
  static std::unique_ptr<EnsembleBlock> block(const AnySplitting& method) {
    return std::make_unique<EnsembleBlockOf<F, Set>>(method.sequence<double>(), method.describe(), method.table());
  }

  static std::unique_ptr<EnsembleBlock> make(const AnySplitting& method, [[maybe_unused]] bool fast, LaneSet lanes) {
#if defined(__x86_64__) && defined(__GNUC__)
    if constexpr (has_fast_kernel) {
      if (fast) return lanes == LaneSet::avx512 ? block<Fast, Avx512Lanes>(method) : nullptr;
    }
    if (lanes == LaneSet::avx512) return block<Family, Avx512Lanes>(method);
    if (lanes == LaneSet::avx2) return block<Family, Avx2Lanes>(method);
#endif
    return lanes == LaneSet::generic ? block<Family, GenericLanes>(method) : nullptr;
  }
};

}  // namespace hamflow
