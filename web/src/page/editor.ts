// The text of the scenario, and the reader's messages at their places.
import { EngineError } from "../engine/engine";
import { place_of } from "../state/toml_edit";
import { element } from "./dom";

const editor = element<HTMLTextAreaElement>("editor");
const complaints = element<HTMLUListElement>("complaints");

function select_place(line: number, column: number): void {
  const at = place_of(editor.value, line, column);
  editor.focus();
  editor.setSelectionRange(at, at + 1);
}

export function complain(error: unknown): void {
  const all = error instanceof EngineError ? error.complaints : [{ line: 0, column: 0, key: "", message: String(error) }];
  complaints.replaceChildren(
    ...all.map((each) => {
      const item = document.createElement("li");
      const text = (each.key ? `${each.key}: ` : "") + each.message;
      if (each.line === 0) item.textContent = text;
      else {
        const place = Object.assign(document.createElement("button"), { type: "button", textContent: `line ${each.line}, column ${each.column}` });
        place.onclick = () => select_place(each.line, each.column);
        item.append(place, `: ${text}`);
      }
      return item;
    }),
  );
}
export function no_complaints(): void {
  complaints.replaceChildren();
}
