// hamflow reproduce: the experiments of both theses, and a page with verdicts; hamflow list experiments, show ID.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "commands.hpp"
#include "experiments.hpp"
#include "guarded.hpp"
#include "hamflow/reproduce/kept_experiment.hpp"
#include "hamflow/reproduce/reproduce.hpp"
#include "progress.hpp"

namespace hamflow::app {

namespace {
using Clock = std::chrono::steady_clock;

std::filesystem::path folder_for(const ReproduceCommandOptions& options) {
  return options.out.empty() ? "reproduce" : options.out;
}

void check_together(const ReproduceCommandOptions& options) {
  if (options.quick && options.full) throw Rejection("--quick", "found --quick with --full; allowed one of them");
  if (options.out == "none")
    throw Rejection("--out", "found --out none; allowed a folder: the page is what reproduce is for");
  if (options.resume && options.force) throw Rejection("--resume", "found --resume with --force; allowed one of them");
}

/// All that is wrong with them is told at once.
std::vector<std::string> ids_of(const std::vector<std::string>& words) {
  std::vector<Complaint> unknown;
  for (const std::string& word : words) {
    try {
      (void)named_experiments({word});
    } catch (const Error& error) {
      unknown.push_back({"", 0, 0, "ID", error.what()});
    }
  }
  if (!unknown.empty()) throw Rejection(std::move(unknown));
  return named_experiments(words);
}

ReproduceRequest request_of(const ReproduceCommandOptions& options) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return {.ids = ids_of(options.what),
          .extent = options.quick  ? WorkExtent::quick
                    : options.full ? WorkExtent::full
                                   : WorkExtent::usual,
          .folder = folder_for(options),
          .existing = options.resume  ? Existing::resume
                      : options.force ? Existing::replace
                                      : Existing::refuse,
          .threads = options.threads > 0 ? options.threads : cores};
}

ReproduceReport carry_out(const ReproduceRequest& request, bool quiet, KeptWork& kept) {
  catch_interrupts();
  Progress progress(0, 0, quiet);
  const Clock::time_point begin = Clock::now();
  return reproduce(request, [&](std::size_t done, std::size_t all) {
    kept.folder = request.folder;
    const double part = static_cast<double>(done) / static_cast<double>(all);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    progress.show(part, done > 0 ? std::optional(seconds * (1 - part) / part) : std::nullopt,
                  fmt::format("experiment {} of {}", std::min(done + 1, all), all));
    return !interrupted();
  });
}
}  // namespace

int reproduce_command(const ReproduceCommandOptions& options) {
  KeptWork kept{.forced = options.force};
  const auto run = [&] {
    check_together(options);
    const ReproduceRequest request = request_of(options);
    const ReproduceReport report = carry_out(request, options.quiet, kept);
    std::cout << (options.json ? report.json : report.text);
    if (!options.json && !options.quiet) {
      std::cout << fmt::format("{:<16}{}\n", "the page", (request.folder / "index.html").string());
      if (report.status == "interrupted")
        std::cout << fmt::format("{:<16}the same command with --resume\n", "to go on");
    }
    for (const ExperimentReport& experiment : report.experiments) {
      if (experiment.status == "failed") print_error(experiment.info.id + ": " + experiment.message);
    }
    return exit_status(report.status);
  };
  return guarded(options.json, run, "", &kept);
}

void list_experiments(bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ExperimentInfo& info : experiment_infos()) {
    if (json) {
      all.push_back({{"id", info.id}, {"thesis", info.thesis}, {"page", info.page}, {"title", info.title}});
    } else {
      std::cout << fmt::format("{:<12} {:<18} p. {:<9} {}\n", info.id, info.thesis, info.page, info.title);
    }
  }
  if (json) std::cout << all.dump(2) << '\n';
}

namespace {
void show_claim(const Claim& claim) {
  const auto line = [](const char* name, const std::string& text) {
    if (!text.empty()) std::cout << fmt::format("    {:<10}{}\n", name, text);
  };
  std::cout << "\n  " << claim.id << '\n';
  line("page", claim.page);
  line("states", claim.statement);
  line("printed", claim.printed);
  line("rule", claim.rule.text);
  for (const Measured& one : claim.measured) {
    const std::string how = one.how.empty() ? "" : " (" + one.how + ")";
    const std::string off = !std::isfinite(one.uncertainty) ? ", not known how certain"
                            : one.uncertainty > 0           ? fmt::format(" +- {:.2g}", one.uncertainty)
                                                            : "";
    line("measured", number_text(one) + off + how);
  }
  line("verdict", fmt::format("{}: {}", name(claim.judgement.verdict), claim.judgement.reason));
}

/// Claims are made while an experiment runs: what it measures stands in them.
void show_claims(const std::string& id, const std::filesystem::path& folder) {
  std::error_code none;
  const bool is_there = std::filesystem::exists(folder / "reproduction", none);
  const auto kept = is_there ? kept_experiment(folder, id) : std::nullopt;
  if (!kept) {
    std::cout << fmt::format(
        "\n  Its claims are made while it runs, and {} has none of this version. To get them:\n"
        "    hamflow reproduce {} --quick{}{}\n    hamflow show {}{}\n",
        folder.string(), id, is_there ? " --resume" : "", folder == "reproduce" ? "" : " --out " + folder.string(), id,
        folder == "reproduce" ? "" : " --out " + folder.string());
    return;
  }
  constexpr const char* sizes[] = {"quick", "default", "full"};
  std::cout << fmt::format("\n  Claims, as judged in {}: size {}, {:.1f} s\n", folder.string(),
                           sizes[static_cast<int>(kept->extent)], kept->seconds);
  for (const Claim& claim : kept->claims) show_claim(claim);
}
}  // namespace

bool show_experiment(const std::string& id, const std::string& folder) {
  for (const ExperimentInfo& info : experiment_infos()) {
    if (info.id != id) continue;
    if (!folder.empty()) kept_experiment(folder, id);  // which refuses what is no reproduction
    std::cout << fmt::format(
        "{}\n  {}\n  {}, {}\n  hamflow reproduce {} [--quick|--full] [--out DIR]\n"
        "  sizes: --quick, default, --full; all experiments together take a minute, 20 minutes, 10 hours on 2 "
        "processors\n",
        info.id, info.title, info.thesis, pages_text(info.page), info.id);
    show_claims(id, folder.empty() ? "reproduce" : folder);
    return true;
  }
  return false;
}

std::vector<std::string> experiment_ids() {
  std::vector<std::string> all;
  for (const ExperimentInfo& info : experiment_infos()) all.push_back(info.id);
  return all;
}

}  // namespace hamflow::app
