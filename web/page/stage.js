// Draws frames on a canvas.
import { SHADES } from "./shades.js";

const BACKGROUND = "#0e131b";
const WALL = "#7e8ca0";
const BODIES = ["#e8a33d", "#d95f59", "#7eb069", "#a381cc", "#4ca9a8"];
const FIXED_BODY = "#6e7a8a";
/** Gas is a veil below all, smoke one above. */
const LAYERS = [
  { phases: ["gas"], opacity: 0.25 },
  { phases: ["liquid", "solid"], opacity: 1 },
  { phases: ["smoke"], opacity: 0.4 },
];
/** Where a number is shown, gas shows it too. */
const LEAST_OPACITY = 0.6;
/** Radius of a disc [spacings]: neighbours overlap a little. */
const RADIUS = 0.62;

/** Colours of numbers: dark violet over blue and green to pale yellow, evenly lighter; or blue over white to red. */
export function ramp(what) {
  return Array.from({ length: SHADES }, (_, k) => {
    const t = k / (SHADES - 1);
    if (what === "density") {
      const arm = 2 * t - 1;
      return `oklch(${0.93 - 0.45 * Math.abs(arm)} ${0.2 * Math.abs(arm)} ${arm < 0 ? 255 : 28})`;
    }
    return `oklch(${0.36 + 0.55 * t} ${0.13 + 0.03 * t} ${285 - 180 * t})`;
  });
}

export class Stage {
  #canvas;
  #pen;
  #scene = null;
  #what = "material";
  #camera = null;
  #sprites = [];

  constructor(canvas) {
    this.#canvas = canvas;
    this.#pen = canvas.getContext("2d");
  }

  begin(scene) {
    this.#scene = scene;
    this.fit();
  }

  show(what) {
    this.#what = what;
    this.fit();
  }

  /** Fits the camera to the canvas: after a change of its size, of the scene, or of colours. */
  fit() {
    if (!this.#scene) return;
    const ratio = window.devicePixelRatio || 1;
    const { width, height } = this.#canvas.getBoundingClientRect();
    this.#canvas.width = Math.max(1, Math.round(width * ratio));
    this.#canvas.height = Math.max(1, Math.round(height * ratio));
    const { min, max } = this.#scene.view;
    const scale = Math.min(this.#canvas.width / (max[0] - min[0]), this.#canvas.height / (max[1] - min[1]));
    this.#camera = {
      scale,
      left: 0.5 * this.#canvas.width - 0.5 * scale * (min[0] + max[0]),
      base: 0.5 * this.#canvas.height + 0.5 * scale * (min[1] + max[1]),
    };
    const colors = this.#what === "material"
      ? this.#scene.materials.map(({ color }) => `rgb(${color.join(" ")})`)
      : ramp(this.#what);
    const radius = Math.max(1, RADIUS * scale * this.#scene.spacing);
    this.#sprites = colors.map((color) => disc(color, radius));
  }

  /** The point of the world under a pointer [m]. */
  place(event) {
    const box = this.#canvas.getBoundingClientRect();
    const ratio = this.#canvas.width / box.width;
    const { scale, left, base } = this.#camera;
    return { x: ((event.clientX - box.left) * ratio - left) / scale, y: (base - (event.clientY - box.top) * ratio) / scale };
  }

  draw(frame) {
    const pen = this.#pen;
    pen.globalAlpha = 1;
    pen.fillStyle = BACKGROUND;
    pen.fillRect(0, 0, this.#canvas.width, this.#canvas.height);
    for (const layer of LAYERS) this.#drawLayer(frame, layer);
    pen.globalAlpha = 1;
    pen.lineJoin = "round";
    pen.lineWidth = Math.max(1.5, 0.002 * this.#canvas.width);
    this.#drawWalls();
    this.#drawBodies(frame.outlines);
  }

  #drawLayer({ positions, materials, shade }, { phases, opacity }) {
    const shown = this.#scene.materials.map(({ phase }) => phases.includes(phase));
    const byNumber = this.#what !== "material" && shade.length > 0;
    this.#pen.globalAlpha = byNumber ? Math.max(opacity, LEAST_OPACITY) : opacity;
    const { scale, left, base } = this.#camera;
    const half = this.#sprites[0].width / 2;
    for (let row = 0; row < materials.length; row++) {
      if (!shown[materials[row]]) continue;
      const sprite = this.#sprites[byNumber ? shade[row] : materials[row]];
      this.#pen.drawImage(sprite, positions[2 * row] * scale + left - half, base - positions[2 * row + 1] * scale - half);
    }
  }

  #drawWalls() {
    this.#pen.strokeStyle = WALL;
    for (const { points, closed } of this.#scene.walls) {
      this.#path(points);
      if (closed) this.#pen.closePath();
      this.#pen.stroke();
    }
  }

  #drawBodies(outlines) {
    const pen = this.#pen;
    let at = 0;
    this.#scene.bodies.forEach(({ fixed }, number) => {
      const corners = outlines[at++];
      if (corners === 0) return;
      if (corners === 1) {
        this.#disc(...outlines.subarray(at, at + 4));
        at += 4;
      } else {
        this.#path(Array.from({ length: corners }, (_, k) => [outlines[at + 2 * k], outlines[at + 2 * k + 1]]));
        pen.closePath();
        at += 2 * corners;
      }
      pen.fillStyle = fixed ? FIXED_BODY : BODIES[number % BODIES.length];
      pen.fill();
      pen.strokeStyle = "#ffffff88";
      pen.stroke();
    });
  }

  #disc(x, y, radius, angle) {
    const { scale, left, base } = this.#camera;
    const center = [x * scale + left, base - y * scale];
    this.#pen.beginPath();
    this.#pen.arc(...center, radius * scale, 0, 7);
    this.#pen.moveTo(...center);
    this.#pen.lineTo(center[0] + 0.7 * radius * scale * Math.cos(angle), center[1] - 0.7 * radius * scale * Math.sin(angle));
  }

  #path(points) {
    const { scale, left, base } = this.#camera;
    this.#pen.beginPath();
    for (const [x, y] of points) this.#pen.lineTo(x * scale + left, base - y * scale);
  }
}

function disc(color, radius) {
  const sprite = document.createElement("canvas");
  sprite.width = sprite.height = 2 * Math.ceil(radius) + 2;
  const pen = sprite.getContext("2d");
  pen.fillStyle = color;
  pen.arc(sprite.width / 2, sprite.width / 2, radius, 0, 7);
  pen.fill();
  return sprite;
}
