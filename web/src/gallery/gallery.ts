// Scenarios to begin with: the files of this folder. The comments at the head of a file say what to look at.
import { files } from "gallery-files";
import type { Display } from "../laboratory";

export interface Entry {
  name: string; // of the file
  title: string;
  look: string;
  question: string;
  display: Display; // "view" of the file: x; y, and any of equal, bodies, turns, z=COLUMN
  speed: number; // log10 of steps a second
  second: string; // a method beside that of the scenario; empty: none
  starts: [number, number][]; // of the section
  toml: string;
}

function entry_of({ name, heads, toml }: (typeof files)[number]): Entry {
  const head = (key: string): string => heads[key] ?? "";
  const [x = "", y = "", ...flags] = head("view").split(/\s*;\s*/);
  const given = (key: string): string => flags.find((flag) => flag.startsWith(`${key}=`))?.slice(key.length + 1) ?? "";
  const is = (flag: string): boolean => flags.includes(flag);
  return {
    name,
    display: { x, y, z: given("z"), equal: is("equal"), bodies: is("bodies"), turns: is("turns") },
    speed: Number(given("speed") || "2.5"),
    title: head("title"), look: head("look"), question: head("question"), second: head("second"),
    starts: head("starts").split(";").filter((each) => each.trim() !== "").map((each) => each.trim().split(/\s+/).map(Number) as [number, number]),
    toml,
  };
}

export const gallery: Entry[] = files.map(entry_of);
