// The blocks of lanes with the fast kernel of one problem. The build makes one translation unit of it per potential
// that has one.
#pragma once

#include "hamflow/problems/support/fast_kernel.hpp"
#include "hamflow/run/ensemble_of.hpp"

namespace hamflow {

/// The blocks of one problem.
struct EnsembleEntry {
  std::string name;
  std::vector<std::pair<std::string, std::string>> variant;
  /// Null where there is none.
  std::unique_ptr<EnsembleBlock> (*make_fast)(const AnySplitting& method, LaneSet lanes) = nullptr;
};

template <template <class> class Family>
class EnsembleUnit {
  template <class R>
  using Fast = FastKernel<Family<R>>;

 public:
  static EnsembleEntry entry() {
    const ProblemInfo info = Family<double>::info();
    return {info.name, info.variant, make_fast};
  }

 private:
  static std::unique_ptr<EnsembleBlock> make_fast([[maybe_unused]] const AnySplitting& method,
                                                  [[maybe_unused]] LaneSet lanes) {
#if defined(__x86_64__) && defined(__GNUC__)
    if (lanes == LaneSet::avx512) {
      return std::make_unique<EnsembleBlockOf<Fast, Avx512Lanes>>(method.sequence<double>(), method.describe(),
                                                                  method.table());
    }
#endif
    return nullptr;
  }
};

}  // namespace hamflow
