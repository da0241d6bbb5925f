// index.html: a summary of verdicts, then a section for each experiment. It holds no times: the same results make the
// same page, byte for byte, however often the work was interrupted. It is one file that needs no other, readable on a
// telephone, in print without colour, and by a screen reader: verdicts are words, figures have alternative texts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "page_words.hpp"
#include "report.hpp"
#include "slim_svg.hpp"
#include "store.hpp"

namespace hamflow::reproduction {

namespace {
namespace fs = std::filesystem;

std::string escaped_html(const std::string& text) {
  std::string all;
  for (const char c : text) {
    if (c == '&') {
      all += "&amp;";
    } else if (c == '<') {
      all += "&lt;";
    } else if (c == '>') {
      all += "&gt;";
    } else if (c == '"') {
      all += "&quot;";
    } else {
      all += c;
    }
  }
  return all;
}

/// Text as part of an address within double quotes.
std::string escaped_address(const std::string& text) {
  std::string all;
  for (const char c : text) {
    switch (c) {
      case '%':
      case '#':
      case '"':
      case '<':
      case '>':
      case '&':
        all += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        break;
      case '\n':
      case '\t':
        all += ' ';  // which an address would lose
        break;
      default:
        all += c;
    }
  }
  return all;
}

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string class_of(ClaimVerdict verdict) {
  std::string word(name(verdict));
  for (char& c : word) c = c == ' ' ? '-' : c;
  return word;
}

const char* const head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>hamflow: two theses, figure by figure</title>
<style>
  :root { color-scheme: light dark; --text: #222; --quiet: #5a5a5a; --line: #d8d8d4; --code: #f4f4f1; --link: #0072b2; --page: #fff; }
  @media screen and (prefers-color-scheme: dark) {
    :root { --text: #e4e4e0; --quiet: #a8a8a2; --line: #44443f; --code: #262624; --link: #6cb8ea; --page: #161615; }
  }
  * { box-sizing: border-box; }
  body { font: 16px/1.55 system-ui, sans-serif; max-width: 72rem; margin: 0 auto; padding: 1rem; color: var(--text); background: var(--page); }
  h1 { font-size: 1.7rem; margin: 1rem 0 0; }
  h2 { font-size: 1.4rem; margin: 2.5rem 0 0.3rem; }
  h3 { font-size: 1.15rem; margin: 2rem 0 0.3rem; padding-top: 1rem; border-top: 1px solid var(--line); overflow-wrap: anywhere; }
  p { max-width: 46rem; }
  a { color: var(--link); }
  nav ul { columns: 20rem; column-gap: 1.5rem; padding: 0; margin: 0.5rem 0; list-style: none; font-size: 0.9rem; }
  nav li { padding: 0.2rem 0; break-inside: avoid; overflow-wrap: anywhere; }
  .theses, .found { padding-left: 1.2rem; max-width: 46rem; }
  .found li { margin: 0.2rem 0; font-size: 0.9rem; overflow-wrap: anywhere; }
  summary { cursor: pointer; padding: 0.2rem 0; }
  dl { max-width: 46rem; font-size: 0.9rem; }
  dt { font-weight: 600; }
  dd { margin: 0 0 0.4rem 1.2rem; }
  .skip { position: absolute; left: -100rem; }
  .skip:focus { position: static; }
  .heard { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
  figure { margin: 0.5rem 0; max-width: 44rem; }
  .figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr)); gap: 1rem; align-items: start; }
  img { display: block; width: 100%; height: auto; background: white; border: 1px solid var(--line); border-radius: 4px; }
  figcaption { margin-bottom: 0.3rem; font-size: 0.9rem; }
  .wide { overflow-x: auto; margin: 0.5rem 0; }
  table { border-collapse: collapse; width: 100%; font-size: 0.9rem; }
  caption { text-align: left; padding: 0.3rem 0; }
  th, td { text-align: left; vertical-align: top; font-weight: 400; padding: 0.35rem 0.6rem 0.35rem 0; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
  .claims th, .claims td { min-width: 7em; }
  .claims th:nth-child(2), .claims td:nth-child(2) { min-width: 3.5em; }
  .claims th:nth-child(4), .claims td:nth-child(4) { min-width: 10em; }
  thead th { font-weight: 600; }
  .numbers th, .numbers td { overflow-wrap: normal; min-width: 5.5rem; }
  .verdict { white-space: nowrap; font-weight: 600; padding: 0.05rem 0.4rem; border-radius: 3px; border: 2px solid; }
  .holds { color: #00705a; border-style: solid; }
  .differs { color: #b04a00; border-style: dashed; }
  .cannot-hold { color: #a01050; border-style: double; border-width: 4px; }
  .undecided { color: #7a6000; border-style: dotted; }
  .nothing-to-test { color: #5a5a5a; border-color: transparent; font-weight: 400; }
  @media screen and (prefers-color-scheme: dark) {
    .holds { color: #4cc9a8; } .differs { color: #f0985a; } .cannot-hold { color: #ff80b5; } .undecided { color: #e0c050; }
    .nothing-to-test { color: #a8a8a2; }
  }
  pre { background: var(--code); padding: 0.6rem; margin: 0.5rem 0; white-space: pre-wrap; overflow-wrap: anywhere; font: 0.8rem/1.45 ui-monospace, monospace; border-radius: 4px; }
  .quiet { color: var(--quiet); font-size: 0.9rem; }
  @media screen and (max-width: 48rem) {
    .claims, .claims tbody, .claims tr, .claims th, .claims td { display: block; width: 100%; min-width: 0 !important; }
    .claims thead { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
    .claims th, .claims td { border: 0; padding: 0.1rem 0; }
    .claims td[data-label]::before { content: attr(data-label) ": "; color: var(--quiet); }
    .claims tr { border-bottom: 1px solid var(--line); padding: 0.5rem 0; }
  }
  @media print {
    @page { margin: 15mm; }
    :root { color-scheme: light; }
    body { font-size: 9pt; line-height: 1.35; max-width: none; padding: 0; color: #000; }
    h3 { margin-top: 1rem; padding-top: 0.5rem; }
    p, pre, .figures, .wide { margin: 0.2rem 0; }
    p, .found, .theses, dl { max-width: none; }
    table { font-size: 8pt; line-height: 1.25; }
    th, td { padding: 0.15rem 0.4rem 0.15rem 0; }
    .quiet, figcaption, dl { font-size: 8pt; }
    .numbers th, .numbers td, .claims th:nth-child(n), .claims td:nth-child(n) { min-width: 0; }
    .numbers th, .numbers td { overflow-wrap: anywhere; }
    .claims { table-layout: fixed; }
    .claims th:nth-child(1) { width: 20%; }
    .claims th:nth-child(2) { width: 6%; }
    .claims th:nth-child(3) { width: 14%; }
    .claims th:nth-child(4) { width: 24%; }
    .claims th:nth-child(6) { width: 17%; }
    h2, h3, h3 + p, figcaption, caption, dt, summary { break-after: avoid; }
    h2, h3, figure, tr, dd, li, pre, .short { break-inside: avoid; }
    thead { display: table-header-group; break-inside: avoid; break-after: avoid; }
    tbody tr:first-child { break-before: avoid; }
    p { orphans: 3; widows: 3; }
    .figures { display: block; }
    figure { display: inline-block; vertical-align: top; width: 8.8cm; margin: 0 0.1cm 0.2cm 0; }
    img { width: auto; max-width: 100%; max-height: 11cm; }
    .wide { overflow: visible; }
    .verdict, .quiet { color: #000; }
    .verdict { display: inline-block; margin-bottom: 0.1rem; }
    .skip { display: none; }
    nav ul { columns: 2; font-size: 8pt; margin: 0.2rem 0; }
    .found li { margin: 0; font-size: 8pt; }
    nav li { padding: 0; }
    details::details-content { content-visibility: visible; height: auto; }
    pre { font-size: 7pt; white-space: pre-wrap; overflow-wrap: anywhere; }
    a { color: #000; text-decoration: none; }
  }
</style>
</head>
)";

/// Before the word, for print without colour; a screen reader has the word.
const char* mark_of(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::holds:
      return "&#10003;";
    case ClaimVerdict::differs:
      return "&#8800;";
    case ClaimVerdict::cannot_hold:
      return "&#10007;";
    case ClaimVerdict::undecided:
      return "?";
    case ClaimVerdict::nothing_to_test:
      break;
  }
  return "&#8211;";
}

std::string verdict_html(ClaimVerdict verdict) {
  return fmt::format("<span class=\"verdict {}\"><span aria-hidden=\"true\">{} </span>{}</span>", class_of(verdict),
                     mark_of(verdict), name(verdict));
}

std::string number_html(const Measured& one) {
  std::string text;
  if (std::isnan(one.value)) {
    text = "no number";
  } else if (!std::isfinite(one.uncertainty)) {
    text = fmt::format("{:.3g}, not known how certain", one.value);
  } else {
    text = number_text(one);
    if (one.uncertainty > 0) text += fmt::format(" &plusmn; {:.2g}", one.uncertainty);
  }
  if (!one.how.empty()) text += "<br><span class=\"quiet\">" + escaped_html(one.how) + "</span>";
  return text;
}

/// Why it is undecided, in terms of the numbers that stand beside it.
std::string doubt(const Claim& claim) {
  if (claim.measured.empty()) return "nothing was measured";
  std::string unclear;
  for (std::size_t i = 0; i < claim.measured.size(); ++i) {
    const Judgement alone = judge(claim.rule, {&claim.measured[i], 1}, Grounds::program);
    if (alone.verdict == ClaimVerdict::undecided) unclear += fmt::format("{}{}", unclear.empty() ? "" : ", ", i + 1);
  }
  if (unclear.empty()) return "the ways of measuring disagree";
  const bool is_one_of_many = claim.measured.size() > 1;
  return (is_one_of_many ? "number " + unclear : std::string("it")) + " may lie on either side of the rule";
}

/// What the verdict says beyond the numbers: these stand in a cell of their own, and who listens hears them once.
std::string remark_on(const Claim& claim) {
  const std::string& reason = claim.judgement.reason;
  switch (claim.judgement.verdict) {
    case ClaimVerdict::holds:
      return "within the rule";
    case ClaimVerdict::differs:
      return "beyond the rule";
    case ClaimVerdict::cannot_hold:
      return claim.grounds == Grounds::identity ? "beyond the rule, which is an identity"
                                                : "beyond the rule in independent ways";
    case ClaimVerdict::undecided: {
      const std::size_t run = reason.find("; would decide: ");
      return doubt(claim) + (run == reason.npos ? "" : reason.substr(run));
    }
    case ClaimVerdict::nothing_to_test:
      break;
  }
  return reason;
}

/// Roles are those that a table has anyway: on a narrow screen its rows are blocks, and would lose them.
std::string claims_html(const std::string& id, const std::vector<Claim>& claims) {
  std::string rows;
  for (const Claim& claim : claims) {
    std::string measured;
    for (const Measured& one : claim.measured) measured += (measured.empty() ? "" : "<br>") + number_html(one);
    const auto cell = [](const char* label, const std::string& text) {
      if (text.empty()) return std::string("<td role=\"cell\"></td>");
      return fmt::format("<td role=\"cell\" data-label=\"{}\">{}</td>", label, text);
    };
    rows += fmt::format("<tr role=\"row\" id=\"{}\"><th role=\"rowheader\" scope=\"row\">{}</th>",
                        escaped_html(claim.id), escaped_html(claim.statement)) +
            cell("page", escaped_html(claim.page)) + cell("printed", escaped_html(claim.printed)) +
            cell("measured", measured) + cell("rule", escaped_html(claim.rule.text)) +
            fmt::format("<td role=\"cell\">{}<br><span class=\"quiet\">{}</span></td></tr>\n",
                        verdict_html(claim.judgement.verdict), escaped_html(remark_on(claim)));
  }
  std::string head_row;
  for (const char* heading : {"claim", "page", "printed", "measured", "rule", "verdict"}) {
    head_row += fmt::format("<th role=\"columnheader\" scope=\"col\">{}</th>", heading);
  }
  return "<table class=\"claims\" role=\"table\"><caption class=\"heard\">Claims of " + escaped_html(id) +
         "</caption>\n<thead role=\"rowgroup\"><tr role=\"row\">" + head_row +
         "</tr></thead>\n<tbody role=\"rowgroup\">\n" + rows + "</tbody></table>\n";
}

std::string table_html(const Table& table) {
  std::string text = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" + escaped_html(table.caption) +
                     "\"><table class=\"numbers\"><caption>" + escaped_html(table.caption) + "</caption>\n<thead><tr>";
  for (const std::string& heading : table.headings) text += "<th scope=\"col\">" + escaped_html(heading) + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i == 0 ? "<th scope=\"row\">" : "<td>") + escaped_html(row[i]) + (i == 0 ? "</th>" : "</td>");
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string figures_html(const fs::path& folder, const Kept& kept) {
  std::string all;
  for (const auto& [name, caption, words] : kept.drawings) {
    all += fmt::format(
        "<figure><figcaption>{}</figcaption><img alt=\"{}\" src=\"data:image/svg+xml;charset=utf-8,{}\"></figure>\n",
        escaped_html(caption), escaped_html(words), escaped_address(slim_svg(text_of_file(folder / (name + ".svg")))));
  }
  return all.empty() ? "" : "<div class=\"figures\">\n" + all + "</div>\n";
}

std::string extent_option(WorkExtent extent) { return extent == WorkExtent::usual ? "" : " --" + name_of(extent); }

/// As a shell takes it.
std::string quoted(const std::string& word) {
  const bool plain = word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-._/") ==
                     std::string::npos;
  return plain ? word : "'" + word + "'";
}

/// Commands that carry the scenarios out, as a shell takes them: each, or where there are many the first of a kind and
/// a loop over the files of the folder.
std::string commands_of(const std::string& id, const std::vector<KeptScenario>& scenarios) {
  constexpr std::size_t few = 8, first = 3;
  const std::string folder = "reproduction/" + id + "/";
  std::vector<std::pair<std::string, std::vector<std::string>>> kinds;  // a command, and the files that it takes
  for (const KeptScenario& scenario : scenarios) {
    auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& one) { return one.first == scenario.command; });
    if (kind == kinds.end()) kind = kinds.insert(kind, {scenario.command, {}});
    kind->second.push_back(quoted(scenario.name + ".toml"));
  }
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  std::string text, cases;
  bool is_loop = false;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto& [command, files] = kinds[k];
    const bool is_told = scenarios.size() <= few || (k > 0 && files.size() <= few);
    for (std::size_t i = 0; i < (is_told ? files.size() : std::min(first, files.size())); ++i) {
      text += "hamflow " + command + " " + folder + files[i] + "\n";
    }
    if (!is_told && files.size() > first) {
      text += fmt::format("# and {} more of the same kind, in {}*.toml\n", files.size() - first, folder);
      is_loop = true;
    }
    if (k == 0) continue;
    for (const std::string& file : files) cases += (cases.empty() || cases.back() == '\n' ? "*/" : "|*/") + file;
    cases += is_told ? ") ;;\n" : ") hamflow " + command + " \"$file\" ;;\n";
  }
  if (!is_loop) return text;
  const std::string most = "hamflow " + kinds[0].first + " \"$file\"";
  return text + "# all of them:\nfor file in " + folder + "*.toml; do " +
         (cases.empty() ? most : "case $file in\n" + cases + "*) " + most + " ;;\nesac") + "; done\n";
}

std::string section_of(const ExperimentReport& report, const fs::path& top) {
  const ExperimentInfo& info = report.info;
  std::string text = fmt::format("<h3 id=\"{0}\">{0}: {1}</h3>\n<p class=\"quiet\">{2}, {3}; size {4}</p>\n",
                                 escaped_html(info.id), escaped_html(info.title), escaped_html(info.thesis),
                                 escaped_html(pages_text(info.page)), name_of(report.extent));
  if (report.status == "failed") return text + "<p>Could not be computed: " + escaped_html(report.message) + "</p>\n";
  if (report.status == "interrupted") return text + "<p>Not computed yet: --resume goes on.</p>\n";
  const fs::path folder = top / "reproduction" / info.id;
  const auto kept = kept_in(folder, fingerprint_of(info.id, report.extent));
  if (kept) text += figures_html(folder, *kept);
  text += claims_html(info.id, report.claims);
  if (!kept) return text;
  for (const Table& table : kept->tables) text += table_html(table);
  for (const std::string& note : kept->notes) text += "<p>" + escaped_html(note) + "</p>\n";
  const std::string commands =
      "hamflow reproduce " + info.id + extent_option(report.extent) + "\n" + commands_of(info.id, kept->scenarios);
  return text + "<details><summary>Commands, in the folder of this page<span class=\"heard\">, of " +
         escaped_html(info.id) + "</span></summary><pre>" + escaped_html(commands) + "</pre></details>\n";
}

/// The claims of a verdict that somebody should look at, each a link to its row.
std::string list_of(const ReproduceReport& report, ClaimVerdict verdict) {
  std::string items;
  int count = 0;
  for (const ExperimentReport& experiment : report.experiments) {
    for (const Claim& claim : experiment.claims) {
      if (claim.judgement.verdict != verdict) continue;
      ++count;
      items += fmt::format("<li><a href=\"#{0}\">{0}</a> {1}{2}</li>\n", escaped_html(claim.id),
                           escaped_html(claim.statement),
                           claim.page.empty() ? "" : ", " + escaped_html(pages_text(claim.page)));
    }
  }
  if (count == 0) return {};
  return fmt::format("<details><summary>{} {}: {}</summary><ul class=\"found\">\n", count,
                     count == 1 ? "claim" : "claims", name(verdict)) +
         items + "</ul></details>\n";
}

std::string words_html() {
  std::string text = "<h2 id=\"words\">Words</h2>\n<dl>\n";
  for (const Word& one : glossary) text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", one.word, one.meaning);
  return text + "</dl>\n";
}
}  // namespace

std::string page_of(const ReproduceReport& report, const fs::path& folder) {
  std::map<ClaimVerdict, int> counts;
  for (const ExperimentReport& one : report.experiments) {
    for (const Claim& claim : one.claims) ++counts[claim.judgement.verdict];
  }
  std::string text = head;
  std::vector<std::string> theses;
  for (const ExperimentReport& one : report.experiments) {
    if (theses.empty() || theses.back() != one.info.thesis) theses.push_back(one.info.thesis);
  }
  text +=
      "<body>\n<a class=\"skip\" href=\"#experiments\">To the experiments</a>\n<header>\n<h1>Two theses, figure by "
      "figure</h1>\n<p>hamflow integrates Hamiltonian systems. Here it repeats what two theses print, and judges "
      "it:</p>\n"
      "<ul class=\"theses\">\n";
  for (const std::string& thesis : theses) {
    text += fmt::format("<li><a href=\"#thesis-{0}\">{0}</a>: {1}</li>\n", escaped_html(thesis), source_of(thesis));
  }
  text +=
      "</ul>\n<p>What was printed, what hamflow measured, and the rule by "
      "which the two were judged. No verdict was typed in: each is computed from its numbers. A claim <em>holds</em> "
      "where everything that the measured number may be lies within the rule, <em>differs</em> where nothing of it "
      "does, <em>cannot hold</em> where it is wrong whatever the program: by an identity, or in two independent "
      "ways. It is <em>undecided</em> where the number is too uncertain, and <em>nothing to test</em> where the thesis "
      "shows no number; neither counts as agreement. Each experiment has three sizes, quick, default and full, and "
      "says on which its verdicts rest. Scenarios, curves (CSV, HDF5) and figures (SVG, PDF, PNG) of each stand in a "
      "folder of its own, reproduction/ID. <a href=\"#words\">Words</a> that claims are told in stand below.</p>\n"
      "</header>\n<main>\n<h2>Verdicts</h2>\n<table><caption "
      "class=\"heard\">How many claims have which verdict</caption>\n<thead><tr><th scope=\"col\">verdict</th><th "
      "scope=\"col\">claims</th></tr></thead>\n<tbody>\n";
  for (const ClaimVerdict verdict : all_claim_verdicts) {
    text += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", verdict_html(verdict), counts[verdict]);
  }
  text += "</tbody></table>\n" + list_of(report, ClaimVerdict::cannot_hold) + list_of(report, ClaimVerdict::differs) +
          words_html() + "<div id=\"experiments\" tabindex=\"-1\">\n";
  for (const std::string& thesis : theses) {
    const std::string called = escaped_html(thesis);
    text += fmt::format("<h2 id=\"thesis-{0}\">{0}</h2>\n<nav aria-label=\"Experiments of {0}\"><ul>\n", called);
    for (const ExperimentReport& one : report.experiments) {
      if (one.info.thesis != thesis) continue;
      text += fmt::format("<li><a href=\"#{0}\">{0}</a> {1}</li>\n", escaped_html(one.info.id),
                          escaped_html(one.info.title));
    }
    text += "</ul></nav>\n";
    for (const ExperimentReport& one : report.experiments) {
      if (one.info.thesis != thesis) continue;
      // On paper it stands on one page.
      const bool is_short = one.claims.size() <= 2;
      text += is_short ? "<div class=\"short\">\n" + section_of(one, folder) + "</div>\n" : section_of(one, folder);
    }
  }
  return text + fmt::format("</div>\n</main>\n<footer><p class=\"quiet\">hamflow {}</p></footer>\n</body>\n</html>\n",
                            escaped_html(HAMFLOW_VERSION));
}

}  // namespace hamflow::reproduction
