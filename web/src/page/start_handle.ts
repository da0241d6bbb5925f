// The start in the picture: a ring that the pointer drags.
import type { Shown } from "../drawing/plane";
import type { Laboratory } from "../laboratory";
import { span_of_key, toml_number, with_value, type Span } from "../state/toml_edit";

const reach = 12; // px

/// Where a column of the start stands in the text; null: it is not a number there.
function entry_of(laboratory: Laboratory, column: string): Span | null {
  const { facts } = laboratory.first;
  for (const [part, names] of [["q", facts.q], ["p", facts.p]] as const) {
    const span = names.includes(column) ? span_of_key(laboratory.toml, facts.settings, `problem.initial.${part}[${names.indexOf(column)}]`) : null;
    if (span === null) continue;
    return /^["'][+-]?["']$/.test(laboratory.toml.slice(span.from, span.to)) ? null : span; // "+": from the energy
  }
  return null;
}

export class StartHandle {
  is_dragged = false;
  private start: [number, number] | null = null;
  private wanted: [number, number] | null = null; // while the one before is computed

  constructor(
    private readonly laboratory: Laboratory,
    canvas: HTMLCanvasElement,
    private readonly shown: () => Shown | undefined,
  ) {
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.is_near(event)) return;
      this.is_dragged = true;
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      canvas.style.cursor = this.is_dragged || this.is_near(event) ? "grab" : "";
      if (this.is_dragged) this.move(this.shown()!.at(event.offsetX, event.offsetY));
    });
    const end = (): void => void (this.is_dragged = false);
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
  }

  /// The start in the picture; null: it cannot be dragged.
  place(): [number, number] | null {
    const { laboratory } = this;
    const { x, y } = laboratory.display;
    if (laboratory.recorded !== null || laboratory.is_edited || entry_of(laboratory, x) === null || entry_of(laboratory, y) === null) return null;
    return this.start;
  }
  opened(): void {
    const { laboratory } = this;
    if (laboratory.recorded !== null) return;
    const { first, display } = laboratory;
    const at = (name: string): number => first.recording.at(0, Math.max(first.column(name), 0));
    this.start = [at(display.x), at(display.y)];
  }

  private is_near(event: PointerEvent): boolean {
    const shown = this.shown();
    const start = this.place();
    return shown !== undefined && start !== null && Math.hypot(shown.px(start[0]) - event.offsetX, shown.py(start[1]) - event.offsetY) < reach;
  }

  private move(to: [number, number]): void {
    const is_free = this.wanted === null;
    this.wanted = to;
    if (is_free) void this.follow();
  }
  private async follow(): Promise<void> {
    for (let done: unknown = null; this.wanted !== null && done !== this.wanted;) {
      done = this.wanted;
      const { x, y } = this.laboratory.display;
      let { toml } = this.laboratory;
      const spans = [{ span: entry_of(this.laboratory, x), value: this.wanted[0] }, { span: entry_of(this.laboratory, y), value: this.wanted[1] }];
      // From the back of the text, so that the places in front stay.
      for (const { span, value } of spans.sort((a, b) => (b.span?.from ?? 0) - (a.span?.from ?? 0))) {
        if (span !== null) toml = with_value(toml, span, toml_number(value, 4));
      }
      await this.laboratory.reopen(toml);
    }
    this.wanted = null;
  }
}
