// Elements of the page.

export function element<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

/// The element that this HTML describes. For texts of the sources only, never of a scenario.
export function made<T extends HTMLElement>(html: string): T {
  const template = document.createElement("template");
  template.innerHTML = html.trim();
  return template.content.firstElementChild as T;
}

export function text_of(parent: HTMLElement, selector: string, text: string): void {
  const found = parent.querySelector(selector)!;
  if (found.textContent !== text) found.textContent = text; // a live region speaks at each change
}

/// An expression may be longer than its axis.
export function label_of(column: string): string {
  return column.length <= 40 ? column : `${column.slice(0, 37)}...`;
}
