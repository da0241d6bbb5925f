// Copies and files of the scenario and of the rows.
import { as_command, as_python, csv_of, save_text } from "../export";
import type { Laboratory } from "../laboratory";
import { element } from "./dom";

function copy(text: string, what: string): void {
  void navigator.clipboard.writeText(text).then(
    () => (element("copied").textContent = `${what} copied`),
    () => (element("copied").textContent = `${what} not copied: the browser refuses it here`),
  );
}

export function connect_exports(laboratory: Laboratory, editor: HTMLTextAreaElement): void {
  element("share").onclick = () => copy(location.href, "link");
  element("copy-python").onclick = () => copy(as_python(editor.value), "Python");
  element("copy-command").onclick = () => copy(as_command(editor.value), "command");
  element("save-toml").onclick = () => save_text("scenario.toml", editor.value, "application/toml");
  element("save-csv").onclick = () => {
    const { columns, rows } = laboratory.tracks[0]!;
    save_text("trajectory.csv", csv_of(columns, Array.from({ length: rows.count }, (_, row) => columns.map((_, column) => rows.at(row, column)))), "text/csv");
  };
}
