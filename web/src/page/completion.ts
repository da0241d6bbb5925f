// The list of completions below the editor. Ctrl+Space or typing opens it, arrows choose, Enter and Tab insert.
import type { Declarations } from "../engine/protocol";
import { completions_at, type Completions } from "../state/complete";
import { element, made } from "./dom";

const most_shown = 8;

export class CompletionList {
  private readonly list = element("completions");
  private found: Completions | null = null;
  private chosen = 0;
  declarations: Declarations | undefined;

  constructor(private readonly editor: HTMLTextAreaElement) {
    editor.addEventListener("input", (event) => {
      const { inputType } = event as InputEvent;
      if (inputType === "insertText" || (inputType === "deleteContentBackward" && this.found !== null)) this.open(false);
      else this.close();
    });
    editor.addEventListener("blur", () => setTimeout(() => this.close(), 150)); // after a click into the list
    editor.addEventListener("keydown", (event) => this.key(event));
  }

  private open(with_nothing_typed: boolean): void {
    if (this.declarations === undefined) return;
    const found = completions_at(this.editor.value, this.editor.selectionStart, this.declarations);
    if (found.all.length === 0 || (found.from === found.to && !with_nothing_typed && this.editor.value[found.from - 1] !== '"')) return this.close();
    this.found = found;
    this.chosen = 0;
    this.draw();
  }
  private close(): void {
    this.found = null;
    this.list.hidden = true;
    this.editor.removeAttribute("aria-activedescendant");
    this.editor.setAttribute("aria-expanded", "false");
  }

  private draw(): void {
    const all = this.found!.all;
    const first = Math.max(0, Math.min(this.chosen - most_shown + 1, all.length - most_shown));
    const items = all.slice(first, first + most_shown).map((each, i) => {
      const item = made(`<li role="option" id="completion-${i}" aria-selected="${first + i === this.chosen}"><b></b> <span></span></li>`);
      item.querySelector("b")!.textContent = each.text;
      item.querySelector("span")!.textContent = each.meaning;
      item.onpointerdown = (event) => {
        event.preventDefault(); // the editor keeps the focus
        this.chosen = first + i;
        this.insert();
      };
      return item;
    });
    this.list.replaceChildren(...items);
    this.list.hidden = false;
    this.editor.setAttribute("aria-expanded", "true");
    this.editor.setAttribute("aria-activedescendant", `completion-${this.chosen - first}`);
  }

  private insert(): void {
    const { from, to, all } = this.found!;
    this.editor.setRangeText(all[this.chosen]!.insert, from, to, "end");
    this.close();
    if (this.editor.value[this.editor.selectionStart - 1] === '"') this.open(true);
  }

  private key(event: KeyboardEvent): void {
    if (event.key === " " && event.ctrlKey) {
      event.preventDefault();
      return this.open(true);
    }
    if (this.found === null || event.ctrlKey || event.metaKey) return;
    const count = this.found.all.length;
    const actions: Record<string, () => void> = {
      ArrowDown: () => ((this.chosen = (this.chosen + 1) % count), this.draw()),
      ArrowUp: () => ((this.chosen = (this.chosen + count - 1) % count), this.draw()),
      Enter: () => this.insert(),
      Tab: () => this.insert(),
      Escape: () => this.close(),
    };
    const action = actions[event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  }
}
