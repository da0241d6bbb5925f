#include "peers.hpp"

namespace bench {

void add_peers(Workload& workload, const Task& task) {
  for (const auto& peers : {odeint_peers(), gsl_peers(), arkode_peers()}) {
    for (const Peer& peer : peers) {
      if (peer.method != workload.method) continue;
      workload.contenders.push_back({peer.library,
                                     [run = peer.run, task](std::int64_t steps) { return run(task, steps); }, "typed",
                                     0, false, peer.slack});
    }
  }
}

}  // namespace bench
