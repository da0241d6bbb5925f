// index.html: a summary of verdicts, then a section for each experiment. It is one file that needs no other, readable
// on a telephone, in print without colour, and by a screen reader: verdicts are words, figures have alternative texts.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

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
<title>hamflow: both theses, figure by figure</title>
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
  nav ul { display: flex; flex-wrap: wrap; gap: 0.2rem 0.9rem; padding: 0; margin: 0.5rem 0; list-style: none; }
  nav a { display: inline-block; padding: 0.2rem 0; }
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
  .numbers th, .numbers td { overflow-wrap: normal; min-width: 4rem; }
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
    body { font-size: 10pt; max-width: none; padding: 0; color: #000; }
    h2, h3 { break-after: avoid; }
    figure, tr { break-inside: avoid; }
    thead { display: table-header-group; }
    .figures { display: block; }
    figure { max-width: 11cm; }
    .wide { overflow: visible; }
    .verdict, .quiet { color: #000; }
    nav, .skip { display: none; }
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
  std::string text = number_text(one);
  if (one.uncertainty > 0) text += fmt::format(" &plusmn; {:.2g}", one.uncertainty);
  if (!one.how.empty()) text += "<br><span class=\"quiet\">" + escaped_html(one.how) + "</span>";
  return text;
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
                        verdict_html(claim.judgement.verdict), escaped_html(claim.judgement.reason));
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

std::string section_of(const ExperimentReport& report, const fs::path& top) {
  const ExperimentInfo& info = report.info;
  std::string text = fmt::format("<h3 id=\"{0}\">{0}: {1}</h3>\n<p class=\"quiet\">{2}, page {3}; size {4}</p>\n",
                                 escaped_html(info.id), escaped_html(info.title), escaped_html(info.thesis),
                                 escaped_html(info.page), name_of(report.extent));
  if (report.status == "failed") return text + "<p>Could not be computed: " + escaped_html(report.message) + "</p>\n";
  if (report.status == "interrupted") return text + "<p>Not computed yet: --resume goes on.</p>\n";
  const fs::path folder = top / "reproduction" / info.id;
  const auto kept = kept_in(folder, fingerprint_of(info.id, report.extent));
  if (kept) text += figures_html(folder, *kept);
  text += claims_html(info.id, report.claims);
  if (!kept) return text;
  for (const Table& table : kept->tables) text += table_html(table);
  for (const std::string& note : kept->notes) text += "<p>" + escaped_html(note) + "</p>\n";
  std::string commands = "hamflow reproduce " + info.id + extent_option(report.extent) + "\n";
  for (const KeptScenario& scenario : kept->scenarios) {
    commands +=
        "hamflow " + scenario.command + " " + quoted("reproduction/" + info.id + "/" + scenario.name + ".toml") + "\n";
  }
  return text + "<details><summary>Commands, in the folder of this page<span class=\"heard\">, of " +
         escaped_html(info.id) + "</span></summary><pre>" + escaped_html(commands) + "</pre></details>\n" +
         fmt::format("<p class=\"quiet\">{:.1f} s</p>\n", report.seconds);
}
}  // namespace

std::string page_of(const ReproduceReport& report, const fs::path& folder) {
  std::map<ClaimVerdict, int> counts;
  double seconds = 0;
  for (const ExperimentReport& one : report.experiments) {
    seconds += one.seconds;
    for (const Claim& claim : one.claims) ++counts[claim.judgement.verdict];
  }
  std::string text = head;
  text +=
      "<body>\n<a class=\"skip\" href=\"#experiments\">To the experiments</a>\n<header>\n<h1>Both theses, figure by "
      "figure</h1>\n<p>What was printed, what hamflow measured, and the rule by "
      "which the two were judged. No verdict was typed in: each is computed from its numbers. A claim <em>holds</em> "
      "where everything that the measured number may be lies within the rule, <em>differs</em> where nothing of it "
      "does, <em>cannot hold</em> where it is wrong whatever the program: by an identity, or in two independent "
      "ways. It is <em>undecided</em> where the number is too uncertain, and <em>nothing to test</em> where the thesis "
      "shows no number; neither counts as agreement. Each experiment has three sizes, quick, default and full, and "
      "says on which its verdicts rest.</p>\n</header>\n<main>\n<h2>Verdicts</h2>\n<table><caption "
      "class=\"heard\">How many claims have which verdict</caption>\n<thead><tr><th scope=\"col\">verdict</th><th "
      "scope=\"col\">claims</th></tr></thead>\n<tbody>\n";
  for (const ClaimVerdict verdict : all_claim_verdicts) {
    text += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", verdict_html(verdict), counts[verdict]);
  }
  text += "</tbody></table>\n<div id=\"experiments\" tabindex=\"-1\">\n";
  std::string thesis;
  for (const ExperimentReport& one : report.experiments) {
    if (one.info.thesis != thesis) {
      thesis = one.info.thesis;
      text += "<h2>" + escaped_html(thesis) + "</h2>\n<nav aria-label=\"Experiments of " + escaped_html(thesis) +
              "\"><ul>\n";
      for (const ExperimentReport& other : report.experiments) {
        if (other.info.thesis == thesis) {
          text += fmt::format("<li><a href=\"#{0}\">{0}</a></li>\n", escaped_html(other.info.id));
        }
      }
      text += "</ul></nav>\n";
    }
    text += section_of(one, folder);
  }
  return text + fmt::format(
                    "</div>\n</main>\n<footer><p class=\"quiet\">hamflow {}, {:.0f} s of "
                    "work.</p></footer>\n</body>\n</html>\n",
                    escaped_html(HAMFLOW_VERSION), seconds);
}

}  // namespace hamflow::reproduction
