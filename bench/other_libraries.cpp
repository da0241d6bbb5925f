#include "other_libraries.hpp"

namespace bench {

void add_other_libraries(Workload& workload, const Task& task) {
  for (const auto& peers : {odeint_peers(), gsl_peers(), arkode_peers()}) {
    for (const OtherLibraryMethod& peer : peers) {
      if (peer.method != workload.method) continue;
      workload.contenders.push_back({peer.library,
                                     [run = peer.run, task](std::int64_t steps) { return run(task, steps); }, "typed",
                                     0, false, peer.slack});
    }
  }
}

}  // namespace bench
