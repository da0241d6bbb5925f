// The list of examples.
import { gallery, type Entry } from "../gallery/gallery";
import { element } from "./dom";

const chooser = element<HTMLSelectElement>("gallery");

export function connect_examples(choose: (entry: Entry) => void): void {
  chooser.append(new Option("choose", ""));
  gallery.forEach((entry, i) => chooser.append(new Option(entry.title, String(i))));
  chooser.onchange = () => chooser.value !== "" && choose(gallery[Number(chooser.value)]!);
}

/// Shows what to look at; null: the scenario is no example.
export function show_lesson(entry: Entry | null): void {
  chooser.value = entry === null ? "" : String(gallery.indexOf(entry));
  element("look").textContent = entry?.look ?? "";
  element("question").textContent = entry?.question ?? "";
  element("lesson").hidden = entry === null;
}
