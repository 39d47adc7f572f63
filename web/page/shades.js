// A number from 0 to 63 for each particle: how far it is along the range of what is shown.

export const SHADES = 64;

const RANGES = {
  material: { range: () => [0, 1], column: () => null },
  speed: { range: (most) => [0, most], column: speeds },
  density: { range: () => [-0.02, 0.02], column: (run) => run.densityErrors },
  temperature: { range: (most) => [0, most], column: (run) => run.temperatures },
};

export class Shades {
  #shown = "material";
  #most = 0;

  begin() {
    this.#most = 0;
  }

  show(what) {
    this.#shown = what;
    this.#most = 0;
  }

  of(run) {
    const { range, column } = RANGES[this.#shown];
    const values = column(run);
    if (!values) return { shade: new Uint8Array(0), range: null };
    // The range follows the largest value at once and sinks slowly.
    this.#most = Math.max(0.995 * this.#most, values.reduce((most, value) => Math.max(most, value), 1e-6));
    const [low, high] = range(this.#most);
    const scale = (SHADES - 1) / (high - low);
    const shade = Uint8Array.from(values, (value) => Math.min(SHADES - 1, Math.max(0, Math.round((value - low) * scale))));
    return { shade, range: [low, high] };
  }
}

function speeds(run) {
  const velocities = run.velocities;
  return Float32Array.from({ length: velocities.length / 2 }, (_, row) =>
    Math.hypot(velocities[2 * row], velocities[2 * row + 1]));
}
