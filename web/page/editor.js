// The scene file as text, with the lines of its mistakes marked.

export class Editor {
  #text;
  #gutter;
  #mistakes;
  #wrong = [];

  constructor(text, gutter, mistakes) {
    [this.#text, this.#gutter, this.#mistakes] = [text, gutter, mistakes];
    text.addEventListener("input", () => this.#number());
    text.addEventListener("scroll", () => {
      gutter.scrollTop = text.scrollTop;
    });
  }

  get text() {
    return this.#text.value;
  }

  set text(text) {
    this.#text.value = text;
    this.clear();
  }

  clear() {
    this.#wrong = [];
    this.#mistakes.textContent = "";
    this.#number();
  }

  /** Shows mistakes as a terminal does, marks their lines and selects the first. */
  mark(text, problems) {
    this.#mistakes.textContent = text;
    this.#wrong = problems.map(({ line }) => line);
    this.#number();
    if (problems.length > 0) this.#select(problems[0]);
  }

  #select({ line, column, length }) {
    const before = this.#text.value.split("\n").slice(0, line - 1);
    const start = before.reduce((sum, one) => sum + one.length + 1, 0) + column - 1;
    this.#text.focus({ preventScroll: true });
    this.#text.setSelectionRange(start, start + length);
    this.#text.scrollTop = Math.max(0, 18 * (line - 6));
  }

  #number() {
    const count = this.#text.value.split("\n").length;
    this.#gutter.replaceChildren(...Array.from({ length: count }, (_, k) => {
      const number = document.createElement("div");
      number.textContent = k + 1;
      number.classList.toggle("wrong", this.#wrong.includes(k + 1));
      return number;
    }));
    this.#gutter.scrollTop = this.#text.scrollTop;
  }
}
