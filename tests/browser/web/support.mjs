// What the tests of the module share.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

/** The folder that `scripts/web.sh` fills. */
export const BUILT = process.env.UNIPBD_WEB;
export const SCENES = fileURLToPath(new URL("../../../scenes/", import.meta.url));

/** Hashes and times of native runs of scene files, by name. */
export function native(frames, paths) {
  const out = execFileSync(process.env.UNIPBD_HASHES, [String(frames), ...paths], { encoding: "utf8" });
  const lines = out.trim().split("\n").map((line) => JSON.parse(line));
  return new Map(lines.map((line) => [line.scene, line]));
}

export const scene = (name) => readFileSync(join(SCENES, `${name}.toml`), "utf8");
