// hamflow-reproduce runs the experiments of both theses and writes a page with verdicts. `hamflow reproduce`, `hamflow
// list experiments` and `hamflow show ID` start it.
#include <fmt/format.h>
#include <sys/mman.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <thread>

#include "hamflow/core/complaint.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_info.hpp"
#include "hamflow/detail/workflow/rejection_json.hpp"
#include "hamflow/figures/stop_drawing.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "progress.hpp"
#include "reproduce.hpp"

namespace {

using namespace hamflow;
using namespace hamflow::reproduction;

enum ExitStatus { exit_done = 0, exit_failed = 1, exit_rejected = 2, exit_file = 3, exit_interrupted = 130 };

struct Options {
  std::vector<std::string> what;  // IDs, gross, sonnleitner, all
  bool quick = false;
  bool full = false;
  std::string out;  // the output directory; empty: reproduce
  bool force = false;
  bool resume = false;
  int threads = 0;  // 0: all cores
  bool json = false;
  bool quiet = false;
  bool list = false;
  std::string shown;  // an ID
};

std::filesystem::path folder_for(const Options& options) { return options.out.empty() ? "reproduce" : options.out; }

void check_together(const Options& options) {
  if (options.quick && options.full) throw Rejection("--quick", "found --quick with --full; allowed one of them");
  if (options.out == "none")
    throw Rejection("--out", "found --out none; allowed a folder, because reproduce writes a page");
  if (options.resume && options.force) throw Rejection("--resume", "found --resume with --force; allowed one of them");
}

/// Reports every unknown word at once.
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

ReproduceRequest request_of(const Options& options) {
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

/// @param begun set to true when the first experiment starts
int carry_out(const Options& options, bool& begun) {
  check_together(options);
  const ReproduceRequest request = request_of(options);
  catch_interrupts();
  const ReproduceReport report = [&] {
    Progress progress(options.quiet);
    return reproduce(request, [&](std::size_t done, std::size_t all) {
      begun = true;
      progress.show(done, all);
      return !interrupted();
    });
  }();
  std::cout << (options.json ? report.json : report.text);
  if (!options.json && !options.quiet) {
    std::cout << fmt::format("{:<16}{}\n", "the page", (request.folder / "index.html").string());
    if (report.status == "interrupted")
      std::cout << fmt::format("{:<16}run the same command with --resume\n", "to continue");
  }
  for (const ExperimentReport& experiment : report.experiments) {
    if (experiment.status == "failed")
      std::cerr << "error: " << experiment.info.id << ": " << experiment.message << '\n';
  }
  if (report.status == "failed") return exit_failed;
  return report.status == "interrupted" ? exit_interrupted : exit_done;
}

int list_experiments(bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ExperimentInfo& info : experiment_infos()) {
    if (json) {
      all.push_back({{"id", info.id}, {"thesis", info.thesis}, {"page", info.page}, {"title", info.title}});
    } else {
      std::cout << fmt::format("{:<12} {:<18} p. {:<9} {}\n", info.id, info.thesis, info.page, info.title);
    }
  }
  if (json) std::cout << all.dump(2) << '\n';
  return exit_done;
}

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
    const std::string off = !std::isfinite(one.uncertainty) ? ", uncertainty unknown"
                            : one.uncertainty > 0           ? fmt::format(" +- {:.2g}", one.uncertainty)
                                                            : "";
    line("measured", number_text(one) + off + how);
  }
  line("verdict", fmt::format("{}: {}", name(claim.judgement.verdict), claim.judgement.reason));
}

/// Shows the claims that are stored in a reproduction. There are none before the experiment runs, because claims
/// contain its measurements.
void show_claims(const std::string& id, const std::filesystem::path& folder) {
  std::error_code none;
  const bool is_there = std::filesystem::exists(folder / "reproduction", none);
  const auto kept = is_there ? stored_experiment(folder, id) : std::nullopt;
  if (!kept) {
    std::cout << fmt::format(
        "\n  The experiment states its claims when it runs, and {} has none from this version. To get them:\n"
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
int show_experiment(const std::string& id, const std::string& folder) {
  for (const ExperimentInfo& info : experiment_infos()) {
    if (info.id != id) continue;
    if (!folder.empty()) stored_experiment(folder, id);  // throws if the folder is not a reproduction
    std::cout << fmt::format(
        "{}\n  {}\n  {}, {}\n  hamflow reproduce {} [--quick|--full] [--out DIR]\n"
        "  sizes: --quick, default, --full; all experiments together take a minute, 20 minutes, 10 hours on 2 "
        "processors\n",
        info.id, info.title, info.thesis, pages_text(info.page), info.id);
    show_claims(id, folder.empty() ? "reproduce" : folder);
    return exit_done;
  }
  throw Rejection("--show", "found experiment " + id + "; allowed an ID of hamflow list experiments");
}

/// Libraries for files crash if a small allocation fails. The program therefore starts only if 64 MB are available:
/// then its own large allocations fail first, and it can report them.
void require_memory() {
  constexpr std::size_t at_hand = std::size_t{64} << 20;
  void* const trial = mmap(nullptr, at_hand, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial == MAP_FAILED) throw std::bad_alloc();
  munmap(trial, at_hand);
}

int rejected(bool json, const std::vector<Complaint>& complaints) {
  for (const Complaint& complaint : complaints) std::cerr << complaint.text() << '\n';
  if (json) std::cout << rejection_json(complaints);
  return exit_rejected;
}

int failed(bool json, const std::string& kind, const std::string& message, int status) {
  std::cerr << "error: " << message << '\n';
  if (json) std::cout << failure_json(kind, message);
  return status;
}

int run(const Options& options) {
  const bool json = options.json;
  bool begun = false;
  const figures::StopDrawingScope watch([] { return !interrupted(); });
  try {
    require_memory();
    if (options.list) return list_experiments(json);
    if (!options.shown.empty()) return show_experiment(options.shown, options.out);
    return carry_out(options, begun);
  } catch (const Rejection& rejection) {
    return rejected(json, rejection.complaints);
  } catch (const figures::DrawingStopped& error) {
    return failed(json, "interrupted", error.what(), exit_interrupted);
  } catch (const FileError& error) {
    return failed(json, "file", error.what(), exit_file);
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(json, "file", error.what(), exit_file);
  } catch (const Error& error) {
    return rejected(json, {{"", 0, 0, "", error.what()}});
  } catch (const std::bad_alloc&) {
    const std::string more =
        fmt::format("; the results so far are in {}; to continue, give the same command with --resume{}",
                    folder_for(options).string(), options.force ? " in place of --force" : "");
    return failed(json, "memory", "out of memory" + (begun ? more : ""), exit_failed);
  } catch (const std::exception& error) {
    return failed(json, "error", error.what(), exit_failed);
  }
}

std::string whole_number(std::string& text, int most) {
  const OptionInfo number{.name = "", .range = Range::whole_from(0, most)};
  std::string refused = refused_value(number, text);
  if (refused.empty()) text = std::to_string(static_cast<long long>(number_value(text)));
  return refused;
}

/// Rejects an option without a value, because CLI11 would take the next option as its value.
void reject_missing_value(const CLI::App& app, int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i) {
    const CLI::Option* const option = app.get_option_no_throw(argv[i]);
    const std::string next = argv[i + 1];
    const bool swallows = next.starts_with("-") && app.get_option_no_throw(next) != nullptr;
    if (option == nullptr || argv[i][0] != '-' || option->get_items_expected_max() == 0 || !(next.empty() || swallows))
      continue;
    throw Rejection(argv[i], "found " + (next.empty() ? std::string("no value") : "the option " + next) + "; allowed " +
                                 argv[i] + " " + option->get_type_name());
  }
}

std::vector<Complaint> complaints_of(const CLI::App& app, const CLI::ParseError& error) {
  std::vector<Complaint> all;
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const std::string& word : app.remaining()) {
    const std::string name = word.substr(0, word.find('='));
    all.push_back(
        {"", 0, 0, name, "found the option " + name + "; allowed " + joined(names) + suggestion(name, names)});
  }
  if (!all.empty()) return all;
  // CLI11 puts the name of the option before the message of its validator.
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  const bool has_name = colon != std::string::npos && text.find_first_of(" '\"") > colon;
  return {{"", 0, 0, has_name ? text.substr(0, colon) : "", has_name ? text.substr(colon + 2) : text}};
}

void declare(CLI::App& app, Options& options) {
  app.name("hamflow reproduce");
  app.set_version_flag("--version", "hamflow-reproduce " HAMFLOW_VERSION);
  app.footer(
      "Examples:\n  hamflow reproduce all --quick\n  hamflow reproduce G2.8 G2.9 --out kepler\n  hamflow reproduce "
      "gross --resume\n  hamflow list experiments");
  app.add_option("experiment", options.what, "IDs of hamflow list experiments; gross, sonnleitner, all")
      ->type_name("ID...");
  app.add_flag("--quick", options.quick, "small size: about a minute for all experiments");
  app.add_flag("--full", options.full, "full size: about ten hours for all experiments");
  app.add_option("--out", options.out, "folder for the page and its data [reproduce]")->type_name("DIR");
  app.add_flag("--force", options.force, "run every experiment again, even where results exist");
  app.add_flag(
      "--resume", options.resume,
      "run only the experiments that are not done or that have changed since: their runs, their rule or the version");
  app.add_option("--threads", options.threads, "number of threads; 0 means all cores; verdicts do not depend on it")
      ->type_name("N")
      ->transform(CLI::Validator([](std::string& text) { return whole_number(text, most_sweep_threads); }, "", ""));
  app.add_flag("--json", options.json, "print only JSON: the entries of verdicts.json for the experiments asked for");
  app.add_flag("--quiet", options.quiet, "print neither progress nor notes");
  app.add_flag("--list", options.list, "list the experiments; the same as hamflow list experiments");
  app.add_option("--show", options.shown,
                 "describe one experiment, with its claims in --out; the same as hamflow show ID")
      ->type_name("ID");
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // then a write beyond the limit of file sizes fails like a write to a full disk
  CLI::App app{"Repeat the experiments of both theses and check their figures, tables and statements"};
  Options options;
  declare(app, options);
  int status = exit_done;
  const bool json = std::any_of(argv, argv + argc, [](const char* word) { return std::string(word) == "--json"; });
  try {
    reject_missing_value(app, argc, argv);
    app.parse(argc, argv);
    if (options.what.empty() && !options.list && options.shown.empty()) throw CLI::RequiredError("experiment");
    status = run(options);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      status = app.exit(error);
    } else {
      status = rejected(json, complaints_of(app, error));
      std::cerr << "Run with --help for more information.\n";
    }
  } catch (const Rejection& rejection) {
    status = rejected(json, rejection.complaints);
  }
  std::cout.flush();
  if (std::cout) return status;
  std::cerr << "error: cannot write to standard output\n";
  return exit_file;
}
