// Small plots against time.
import { shown } from "./sliders.js";

/** Frames that a plot shows. */
const LENGTH = 600;

export class Plot {
  #canvas;
  #label;
  #lines;
  #rows = [];

  /** `lines`: name, colour and value of each line, taken from the diagnostics, `relative` to its lowest; `unit` of all. */
  constructor(canvas, label, unit, lines) {
    this.#canvas = canvas;
    this.#label = label;
    this.#lines = lines;
    this.unit = unit;
  }

  clear() {
    this.#rows = [];
  }

  add(diagnostics) {
    this.#rows.push(this.#lines.map(({ value }) => value(diagnostics)));
    if (this.#rows.length > LENGTH) this.#rows.shift();
    this.draw();
  }

  draw() {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [this.#canvas.clientWidth, this.#canvas.clientHeight];
    if (width === 0 || this.#rows.length === 0) return;
    Object.assign(this.#canvas, { width: width * ratio, height: height * ratio });
    const pen = this.#canvas.getContext("2d");
    pen.scale(ratio, ratio);
    const lowest = this.#lines.map(({ relative }, line) => (relative ? Math.min(...this.#rows.map((row) => row[line])) : 0));
    const rows = this.#rows.map((row) => row.map((value, line) => value - lowest[line]));
    const all = rows.flat();
    const low = Math.min(0, ...all);
    const high = Math.max(...all, low + 1e-9);
    const y = (value) => height - 2 - (value - low) / (high - low) * (height - 4);
    pen.strokeStyle = "#2b3645";
    pen.strokeRect(0.5, 0.5, width - 1, height - 1);
    this.#lines.forEach(({ color }, line) => {
      pen.strokeStyle = color;
      pen.lineWidth = 1.5;
      pen.beginPath();
      rows.forEach((row, k) => pen.lineTo(k / (LENGTH - 1) * width, y(row[line])));
      pen.stroke();
    });
    const last = rows.at(-1);
    this.#label.replaceChildren(...this.#lines.map(({ name, color }, line) => {
      const part = document.createElement("span");
      part.style.color = color;
      part.textContent = `${name} ${shown(last[line])} ${this.unit}  `;
      return part;
    }));
  }
}
