// Play, step, reverse, the speed and the time line.
import { short } from "../drawing/layout";
import type { Laboratory } from "../laboratory";
import { element } from "./dom";

export class Clock {
  private readonly speed = element<HTMLInputElement>("speed");
  private readonly scrub = element<HTMLInputElement>("scrub");

  constructor(private readonly laboratory: Laboratory) {
    element("play").onclick = () => this.play();
    element("step").onclick = () => laboratory.step();
    element("reverse").onclick = () => laboratory.reverse();
    this.speed.oninput = () => {
      laboratory.speed = 10 ** Number(this.speed.value);
      laboratory.changed = true;
    };
    this.scrub.oninput = () => laboratory.mark(Number(this.scrub.value));
    document.onkeydown = (event) => this.key(event);
  }

  /// The button answers at once, not with the next picture.
  private play(): void {
    this.laboratory.play();
    if (!this.laboratory.is_empty) this.draw();
  }
  private key(event: KeyboardEvent): void {
    if ((event.target as HTMLElement).closest("input, textarea, select, button, summary, [role=listbox]") || event.ctrlKey || event.metaKey || event.altKey) return;
    const { laboratory } = this;
    const action = { " ": () => this.play(), ArrowRight: () => laboratory.step(), r: () => laboratory.reverse(), R: () => laboratory.reverse() }[event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  }

  draw(): void {
    const { recorded, playing } = this.laboratory;
    const track = this.laboratory.tracks[0]!;
    const row = this.laboratory.row(track);
    this.scrub.max = String(track.rows.count - 1);
    this.scrub.value = String(row);
    this.speed.value = String(Math.log10(this.laboratory.speed));
    element("time-text").textContent = recorded?.given.kind === "sweep" ? `member ${row}` : `t = ${short(track.rows.at(row, 0))}`;
    element("speed-text").textContent = `${short(this.laboratory.speed)} ${recorded === null ? "steps/s" : "/s"}`;
    element("play").textContent = playing ? "Pause" : "Play";
    for (const id of ["step", "reverse"]) element<HTMLButtonElement>(id).disabled = recorded !== null;
    element<HTMLButtonElement>("play").disabled = false;
  }
}
