// The command line: declares the options, parses them and calls the commands. It contains no numerics.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>

#include "command_line.hpp"
#include "commands.hpp"
#include "figure_kinds.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/core/version.hpp"
#include "hamflow/detail/workflow/rejection_json.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/scenario/coordinates.hpp"
#include "hamflow/workflow/sweep.hpp"

namespace {

using namespace hamflow::app;

CLI::App* add(CLI::App& app, const char* name, const char* what, const char* examples) {
  CLI::App* sub = app.add_subcommand(name, what);
  sub->footer(std::string("Examples:\n") + examples);
  return sub;
}

/// The keys that choose between problems of the same name, each with the names of these problems.
std::vector<std::pair<std::string, std::vector<std::string>>> problems_by_choice() {
  std::vector<std::pair<std::string, std::vector<std::string>>> all;
  for (const hamflow::ProblemEntry& entry : hamflow::problems()) {
    if (entry.structure) continue;  // the choices of such an entry are typed in the scenario
    for (const auto& choice : entry.info.variant) {
      const auto same = [&](const auto& one) { return one.first == choice.first; };
      auto place = std::find_if(all.begin(), all.end(), same);
      if (place == all.end()) place = all.insert(place, {choice.first, {}});
      std::vector<std::string>& owners = place->second;
      if (std::find(owners.begin(), owners.end(), entry.info.name) == owners.end()) owners.push_back(entry.info.name);
    }
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file at its size limit then fails in write(), as on a full disk
  CLI::App app{"hamflow integrates Hamiltonian systems and shows which structure a method preserves."};
  app.name("hamflow");
  app.set_version_flag("--version", "hamflow " HAMFLOW_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n  hamflow run examples/kepler_ellipse.toml\n  hamflow list methods\n  hamflow verify stv4\n"
      "Exit status: 0 done, 1 the run failed, 2 the request was wrong, 3 input or output failed, 130 stopped by "
      "Ctrl-C.");
  int status = exit_done;

  RunOptions run;
  CLI::App* run_command =
      add(app, "run", "Run a scenario: integrate, record samples, draw figures, print a summary",
          "  hamflow run kepler.toml\n  hamflow run kepler.toml --set run.dt=0.05 --set method.name=verlet "
          "--out finer.run\n  hamflow run kepler.toml --json --out none\n"
          "  hamflow run kepler.toml --resume\n");
  run_command->add_option("scenario", run.scenario, "the scenario, a TOML file")->required()->type_name("FILE");
  run_command->add_option("--set", run.sets, "override a key: dotted path and TOML value, e.g. run.dt=0.05")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  run_command->add_option("--out", run.out, "output folder [FILE without .toml, plus .run]; \"none\" writes nothing")
      ->type_name("DIR");
  run_command->add_flag("--force", run.force, "replace the run in an existing folder");
  run_command->add_flag("--resume", run.resume, "continue from the last checkpoint, or take more steps after the end");
  run_command->add_flag("--json", run.json, "print only the summary, as JSON, on stdout");
  run_command->add_flag("--quiet", run.quiet, "print no progress and no notes");
  run_command->callback([&] { status = hamflow::app::run_command(run); });

  PlotOptions plot;
  CLI::App* plot_command =
      add(app, "plot", "Draw a figure of one or several runs, finished, running or interrupted",
          "  hamflow plot kepler.run -o orbit.svg\n  hamflow plot kepler.run --kind energy-error -o e.pdf\n"
          "  hamflow plot coarse.run fine.run --kind energy-error --size 8.5x6 --no-title -o both.pdf\n"
          "  hamflow plot kepler.run --kind time --y x,p_x --dpi 600 -o x.png\n"
          "  hamflow plot gas_121.run --kind particles --at 0,0.01 -o gas.png\n");
  plot_command->add_option("run", plot.runs, "folders of runs, or their files run.h5")->required()->type_name("RUN...");
  plot_command->add_option("--kind", plot.kind, hamflow::joined(hamflow::figure_names()))
      ->type_name("KIND")
      ->check(CLI::Validator(hamflow::unknown_figure, "", ""));
  plot_command
      ->add_option("--x", plot.x, "column of the horizontal axis, for the kinds orbit, phase, time, particles, tracks")
      ->type_name("COLUMN");
  plot_command->add_option("--y", plot.y, "columns of the vertical axis, separated by commas")->type_name("COLUMN,...");
  plot_command->add_option("--at", plot.at, "times to draw, separated by commas, for the kinds particles and radial")
      ->type_name("T,...");
  plot_command->add_option("--size", plot.size, "width and height in centimetres, e.g. 8.5x6; or 85x60mm, 3.35x2.4in")
      ->type_name("WxH");
  plot_command->add_option("--dpi", plot.dpi, "resolution of a .png in pixels per inch [300]")
      ->type_name("N")
      ->transform(whole_number(50, 2400));
  plot_command->add_flag("--no-title", plot.no_title, "omit the title above the figure");
  plot_command->add_option("-o,--output", plot.file, "the file to write: .svg, .pdf or .png")
      ->required()
      ->type_name("FILE");
  plot_command->callback([&] { status = hamflow::app::plot_command(plot); });

  ViewOptions view;
  CLI::App* view_command =
      add(app, "view", "Open the laboratory, a page in which the integrators run, with a run, a sweep or a scenario",
          "  hamflow view\n  hamflow view kepler.run\n  hamflow view kepler.toml -o kepler.html --no-browser\n");
  view_command->add_option("input", view.input, "the folder of a run or a sweep, run.h5, sweep.h5, or a scenario")
      ->type_name("RUN|SWEEP|SCENARIO");
  view_command->add_option("-o,--output", view.file, "the file to write [NAME.html; without an input laboratory.html]")
      ->type_name("FILE");
  view_command->add_flag("!--no-browser", view.browser, "write the file without opening it");
  view_command->callback([&] { status = hamflow::app::view_command(view); });

  SweepCommandOptions sweep;
  CLI::App* sweep_command = add(
      app, "sweep", "Run a scenario for many values of some keys, on all cores; the table has one row per run",
      "  hamflow sweep kepler.toml --vary problem.orbit.r_aph=1:5:1000\n"
      "  hamflow sweep pendulum.toml --vary 'problem.initial.q[0]=-3:3:200' --vary 'problem.initial.p[0]=-2:2:200'\n"
      "  hamflow sweep henon.toml --vary problem.initial.q[1]=-0.4:0.6:100 --figure section.png\n"
      "  hamflow sweep kepler.toml --vary 'problem.initial.q[0]=1:2:9' --vary "
      "'problem.initial.p[1]=sqrt(1/problem.initial.q[0])'\n"
      "  hamflow sweep kepler.toml --vary method.name=verlet,stv4,yoshida6 --vary run.dt=0.1,0.05,0.025 --json "
      "--out none\n");
  sweep_command->add_option("scenario", sweep.scenario, "the scenario, a TOML file [required without --merge]")
      ->type_name("FILE");
  sweep_command
      ->add_option(
          "--vary", sweep.varied,
          "a key and its values: PATH=a:b:n (n values from a to b), PATH=v1,v2,..., or PATH=FORMULA, a formula of "
          "other varied keys, named by their paths; several --vary give every combination, the last one varies "
          "fastest [required without --merge]")
      ->type_name("PATH=VALUES")
      ->allow_extra_args(false);
  sweep_command->add_flag("--zip", sweep.zip,
                          "combine the n-th values of all keys instead of forming every combination");
  sweep_command->add_option("--set", sweep.sets, "override a key for all members, e.g. run.dt=0.05")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  sweep_command
      ->add_option("--out", sweep.out, "output folder [FILE without .toml, plus .sweep]; \"none\" writes nothing")
      ->type_name("DIR");
  sweep_command
      ->add_option("--shard", sweep.shard,
                   "run only the members k with k mod COUNT = INDEX, in a folder of its own within --out; auto: the "
                   "numbers come from Slurm, Open MPI or PMI")
      ->type_name("INDEX/COUNT");
  sweep_command
      ->add_option("--merge", sweep.merge,
                   "write the table of a sweep whose shards are in DIR; members that are not finished are not_run")
      ->type_name("DIR");
  sweep_command->add_option("--threads", sweep.threads, "number of threads, 0: all cores; does not change results")
      ->type_name("N")
      ->transform(whole_number(0, hamflow::most_sweep_threads));
  sweep_command
      ->add_option("--lanes", sweep.lanes,
                   "SIMD instructions: auto, none, generic, avx2, avx512; does not change results")
      ->type_name("SET");
  sweep_command
      ->add_option("--figure", sweep.figure,
                   "draw the column --colour as a function of the one or two varied keys; without --colour, the "
                   "Poincare section of all members; .svg, .pdf or .png")
      ->type_name("FILE");
  sweep_command
      ->add_option("--colour", sweep.colour,
                   "the column to draw, e.g. observables/lyapunov1 [the section; without a section energy/max_error]")
      ->type_name("COLUMN");
  sweep_command->add_flag("--mean", sweep.mean,
                          "draw the mean of --colour over all varied keys except the first, with its standard error; "
                          "--colour may then name several columns, separated by commas");
  sweep_command->add_flag("--force", sweep.force, "replace the sweep in an existing folder");
  sweep_command->add_flag("--resume", sweep.resume,
                          "continue the sweep in an existing folder; finished members are not run again");
  sweep_command->add_flag("--json", sweep.json,
                          "print only the summary, as JSON, on stdout; with --out none and at most 10^4 members it "
                          "includes their rows");
  sweep_command->add_flag("--quiet", sweep.quiet, "print no progress and no notes");
  sweep_command->callback([&] { status = hamflow::app::sweep_command(sweep); });

  VerifyOptions verify;
  CLI::App* verify_command =
      add(app, "verify", "Measure the properties of methods: order, symplecticity, reversibility, energy",
          "  hamflow verify stv4 'cg(1,5)'\n  hamflow verify --all\n  hamflow verify rk4 --problem pendulum\n");
  verify_command->add_option("method", verify.methods, "methods to measure, e.g. stv4, 'cg(1,5)'")->type_name("METHOD");
  verify_command->add_flag("--all", verify.all, "measure every method of the catalogue");
  verify_command
      ->add_option("--problem", verify.problem,
                   "measure on this problem; conservation of momentum maps is also measured on a Kepler ellipse and "
                   "three bodies")
      ->type_name("PROBLEM");
  verify_command->add_flag("--json", verify.json, "print JSON");
  verify_command->callback([&] { status = hamflow::app::verify_command(verify); });

  CertifyOptions certify;
  CLI::App* certify_command = add(
      app, "certify", "Classify the energy error in the log of any program: bounded, random walk, linear or undecided",
      "  hamflow certify energy.csv --time t --energy E\n  hamflow certify columns.txt --time 1 --energy 4\n"
      "  hamflow certify log.lammps --time Step --energy TotEng\n"
      "  hamflow certify run.h5 --time samples/t --energy samples/e:2 --scale 0.5 --json\n");
  certify_command
      ->add_option(
          "file", certify.file,
          "columns separated by commas, semicolons or blanks, with or without names; a LAMMPS log (its last thermo "
          "table is read); or HDF5")
      ->required()
      ->type_name("FILE");
  const char* const column =
      "its name, or its number from 1; in HDF5 the path of a dataset, PATH:2 for its second column";
  certify_command->add_option("--time", certify.time, std::string("the column of the times: ") + column)
      ->required()
      ->type_name("COLUMN");
  certify_command->add_option("--energy", certify.energy, "the column of the energies, named in the same way")
      ->required()
      ->type_name("COLUMN");
  certify_command
      ->add_option("--scale", certify.scale,
                   "the energy by which errors are divided [the absolute value of the first energy]")
      ->type_name("X");
  certify_command->add_flag("--json", certify.json, "print only JSON on stdout");
  certify_command->callback([&] { status = hamflow::app::certify_command(certify); });

  ReverseOptions reverse;
  CLI::App* reverse_command =
      add(app, "reverse", "Test time reversibility: integrate forward and back, and compare with the start",
          "  hamflow reverse kepler.toml\n  hamflow reverse kepler.toml --set method.name=stv4 --set "
          "run.arithmetic=lattice\n");
  reverse_command->add_option("scenario", reverse.scenario, "the scenario, a TOML file")->required()->type_name("FILE");
  reverse_command->add_option("--set", reverse.sets, "override a key: dotted path and TOML value, e.g. run.dt=0.05")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  reverse_command
      ->add_option("--out", reverse.out,
                   "output folder for the states at the start, the turning point and the end; \"none\" writes "
                   "nothing [none]")
      ->type_name("DIR");
  auto* const reverse_force =
      reverse_command->add_flag("--force", reverse.force, "replace the reversal in an existing folder");
  reverse_command->add_flag("--resume", reverse.resume, "continue an interrupted reversal from its last checkpoint")
      ->excludes(reverse_force);
  reverse_command->add_flag("--json", reverse.json, "print only JSON on stdout");
  reverse_command->add_flag("--quiet", reverse.quiet, "print no progress and no notes");
  reverse_command->callback([&] { status = hamflow::app::reverse_command(reverse); });

  // hamflow-reproduce parses the options of `reproduce` and prints its help.
  app.add_subcommand("reproduce",
                     "Repeat the experiments of both theses and check their figures, tables and statements");

  CompareOptions compare;
  CLI::App* compare_command =
      add(app, "compare", "Compare methods (work-precision): error, evaluations and time, for several step sizes",
          "  hamflow compare kepler.toml --methods 'verlet,stv4,cg(1,5)'\n"
          "  hamflow compare kepler.toml --methods stv4,rk4 --dt 0.1,0.05,0.025 --figure work.svg --csv work.csv\n");
  compare_command->add_option("scenario", compare.scenario, "the scenario, a TOML file")->required()->type_name("FILE");
  compare_command->add_option("--methods", compare.methods, "methods, separated by commas, e.g. 'verlet,stv4,cg(1,5)'")
      ->required()
      ->type_name("METHODS");
  compare_command
      ->add_option("--dt", compare.dts,
                   "step sizes, separated by commas; each is replaced by the nearest one that divides t_end "
                   "[from twice run.dt down to a sixteenth of it]")
      ->type_name("DT");
  compare_command->add_option("--set", compare.sets, "override a key: dotted path and TOML value, e.g. run.t_end=10")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  compare_command->add_option("--out", compare.out, "output folder for compare.json, compare.csv and figures/ [none]")
      ->type_name("DIR|none");
  compare_command->add_flag("--force", compare.force, "replace the files in an existing folder");
  compare_command->add_option("--csv", compare.csv, "write the table to a CSV file")->type_name("FILE");
  compare_command->add_option("--figure", compare.figure, "draw the work-precision diagram: .svg, .pdf or .png")
      ->type_name("FILE");
  compare_command->add_flag("--json", compare.json, "print only JSON on stdout");
  compare_command->add_flag("--quiet", compare.quiet, "print no progress and no notes");
  compare_command->callback([&] { status = hamflow::app::compare_command(compare); });

  ShellOptions shell;
  CLI::App* shell_command = add(
      app, "shell",
      "Control a run by typed commands: step n, dt x, tol x, method m, show, save, reset, reverse, help, quit",
      "  hamflow shell kepler.toml\n  printf 'step 100\\ndt 0.01\\nstep 100\\nshow\\nsave fine.run\\n' | hamflow shell "
      "kepler.toml\n");
  shell_command->add_option("scenario", shell.scenario, "the scenario, a TOML file")->required()->type_name("FILE");
  shell_command->add_option("--set", shell.sets, "override a key: dotted path and TOML value, e.g. run.dt=0.05")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  shell_command->add_flag("--json", shell.json, "let the command show print one JSON object per line");
  shell_command->add_flag("--quiet", shell.quiet, "print no progress and no notes");
  shell_command->callback([&] { status = hamflow::app::shell_command(shell); });

  NewOptions fresh;
  CLI::App* new_command = add(app, "new", "Print a scenario for a problem, to start from",
                              "  hamflow new central-force > my.toml && hamflow run my.toml\n"
                              "  hamflow new henon-heiles --method 'cg(2,6)' --all > all.toml\n"
                              "  hamflow new central-force --potential hooke --coordinates polar > hooke.toml\n");
  new_command->add_option("problem", fresh.problem, "a problem; hamflow list problems lists them")
      ->required()
      ->type_name("PROBLEM");
  for (const auto& [key, owners] : problems_by_choice()) {
    new_command->add_option("--" + key, fresh.variant[key], "for " + hamflow::joined(owners));
  }
  new_command->add_option("--method", fresh.method, "the method, with its options, e.g. 'cg(2,6)' [the usual one]")
      ->type_name("METHOD");
  new_command->add_flag("--all", fresh.all,
                        "print every key of the problem and the method; keys that are not set are comments");
  new_command->callback([&] { status = hamflow::app::new_command(fresh); });

  ConvertOptions convert;
  CLI::App* convert_command = add(
      app, "convert", "Convert a scenario, a run or a state to other coordinates of its problem",
      "  hamflow convert kepler.toml --to polar -o polar.toml\n  hamflow convert kepler.run --to polar -o polar.csv\n"
      "  hamflow convert --from cartesian --to polar --q 1,0 --p 0,1\n");
  convert_command->add_option("input", convert.input, "a scenario, the folder of a run, or its run.h5")
      ->type_name("INPUT");
  convert_command->add_option("--to", convert.to, hamflow::what_charts_there_are())
      ->required()
      ->type_name("COORDINATES");
  convert_command->add_option("--from", convert.from, "the coordinates of --q and --p")->type_name("COORDINATES");
  convert_command->add_option("--q", convert.q, "the positions of a state, separated by commas")->type_name("Q1,Q2");
  convert_command->add_option("--p", convert.p, "the canonical momenta of the state")->type_name("P1,P2");
  convert_command
      ->add_option("--set", convert.sets, "override a key of the scenario before the conversion, e.g. method.name=cg")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  convert_command->add_option("-o,--output", convert.output, "output file; for a run .h5 or .csv [stdout]")
      ->type_name("FILE");
  convert_command->add_flag("--json", convert.json, "print the state, or the states of a run, as JSON");
  convert_command->callback([&] { status = hamflow::app::convert_command(convert); });

  std::string what;
  bool list_all = false;
  bool list_json = false;
  CLI::App* list_command = add(
      app, "list", "List methods, problems or experiments",
      "  hamflow list methods\n  hamflow list methods --all\n  hamflow list problems\n  hamflow list experiments\n");
  list_command->add_option("what", what, "methods, problems or experiments")
      ->required()
      ->check(one_of({"methods", "problems", "experiments"}));
  list_command->add_flag("--all", list_all, "list every method on a separate line");
  list_command->add_flag("--json", list_json, "print JSON; it always lists all");
  list_command->callback([&] { status = hamflow::app::list_command(what, list_all, list_json); });

  std::string name, shown_folder;
  CLI::App* show_command = add(app, "show", "Describe a problem, a method, a figure or an experiment",
                               "  hamflow show central-force\n  hamflow show cg\n  hamflow show S-T81 --out quick\n");
  show_command->add_option("name", name, "a problem, a method, a figure or an experiment")
      ->required()
      ->type_name("NAME");
  show_command
      ->add_option("--out", shown_folder,
                   "for an experiment: the output folder of hamflow reproduce; its results are shown too [reproduce]")
      ->type_name("DIR");
  show_command->callback([&] { status = hamflow::app::show_command(name, shown_folder); });

  std::string cited;
  CLI::App* cite_command = add(app, "cite", "Print the works behind a run, a method or a problem, as BibTeX",
                               "  hamflow cite kepler.run > works.bib\n  hamflow cite kahan-li8\n");
  cite_command->add_option("name", cited, "the folder of a run, a scenario file, a method or a problem")
      ->required()
      ->type_name("NAME");
  cite_command->callback([&] { status = hamflow::app::cite_command(cited); });

  if (argc > 1 && std::string(argv[1]) == "reproduce") return written_out(reproduce_command({argv + 2, argv + argc}));
  try {
    reject_unknown_command(app, argc, argv);
    reject_missing_value(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // The statuses of CLI11 start at 100. Help returns 0; every other one is a wrong request.
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return written_out(app.exit(error));
    const std::vector<hamflow::Complaint> complaints = complaints_of(app, error);
    status = exit_rejected;
    for (const hamflow::Complaint& one : complaints) std::cerr << one.text() << '\n';
    std::cerr << "Run with --help for more information.\n";
    const std::vector<std::string> words(argv, argv + argc);
    if (std::find(words.begin(), words.end(), "--json") != words.end())
      std::cout << hamflow::rejection_json(complaints);
  }
  return written_out(status);
}
