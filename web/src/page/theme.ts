// Light and dark.
import { element } from "./dom";

export function connect_theme(changed: () => void): void {
  const choose = (dark: boolean): void => {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    element("theme").setAttribute("aria-pressed", String(dark));
    changed();
  };
  element("theme").onclick = () => choose(document.documentElement.dataset.theme !== "dark");
  choose(matchMedia("(prefers-color-scheme: dark)").matches);
}
