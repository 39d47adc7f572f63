//! The same bits on every instruction set and number of threads, in scenes large enough that threads are used.

use crate::support::Place;

/// Kinds of scene, each with more than the 4,096 rows from which on loops are shared among threads.
const SCENES: [(&str, &str); 8] = [
    (
        "liquid",
        "spacing = 0.02\n[solver]\nsubsteps = 3\nsettle_substeps = 2\n[[liquid]]\nname = \"water\"\nxsph = 0.05\n\
      [[block]]\nmaterial = \"water\"\nmin = [0.0, 0.0]\nmax = [1.4, 1.4]\n[[tank]]\nmin = [0.0, 0.0]\nmax = [2.0, 2.0]\n\
      [[body]]\nsize = [0.3, 0.2]\nposition = [1.6, 0.5]\n[[body]]\nradius = 0.1\nposition = [1.7, 0.9]\n",
    ),
    (
        "bodies",
        "spacing = 0.02\n[solver]\nsubsteps = 3\n[[liquid]]\nname = \"water\"\n[[block]]\nmaterial = \"water\"\n\
      min = [-0.2, 0.0]\nmax = [-0.1, 0.1]\n[[half_plane]]\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n[[body]]\n\
      size = [0.05, 0.05]\nposition = [0.1, 0.025]\nrolling_friction = 0.1\n\
      copies = { columns = 40, rows = 30, step = [0.05, 0.05] }\n[[body]]\nradius = 0.025\nposition = [0.11, 1.525]\n\
      restitution = 0.5\nvelocity = [0.0, -3.0]\ncopies = { columns = 38, rows = 8, step = [0.05, 0.05] }\n",
    ),
    (
        "grid",
        "spacing = 0.02\n[solver]\npressure_grid = \"on\"\nsettle_substeps = 2\n[[liquid]]\nname = \"water\"\n[[block]]\n\
      material = \"water\"\nmin = [0.0, 0.0]\nmax = [1.4, 1.4]\n[[tank]]\nmin = [0.0, 0.0]\nmax = [2.0, 2.0]\n",
    ),
    (
        "gas",
        "spacing = 0.02\n[solver]\nsubsteps = 3\nsettle_substeps = 2\n[[gas]]\nname = \"air\"\nvorticity = 2.0\n\
      conductivity = 0.0004\n[[smoke]]\nname = \"soot\"\n[[block]]\nmaterial = \"air\"\nmin = [0.0, 0.0]\nmax = [1.4, 1.4]\n\
      temperature = 1.0\njitter = 0.1\n[[tank]]\nmin = [0.0, 0.0]\nmax = [1.4, 1.4]\n[[points]]\nmaterial = \"soot\"\n\
      positions = [[0.5, 0.5], [0.6, 0.5]]\n",
    ),
    (
        "soft and ropes",
        "spacing = 0.02\n[solver]\nsubsteps = 3\nsettle_substeps = 2\n[[liquid]]\nname = \"water\"\n[[solid]]\n\
      name = \"hemp\"\n[[block]]\nmaterial = \"water\"\nmin = [0.0, 0.0]\nmax = [1.4, 1.3]\n[[tank]]\nmin = [0.0, 0.0]\n\
      max = [2.0, 2.0]\n[[body]]\nsolver = \"shape_matching\"\ncompliance = 1e-6\nradius = 0.15\nposition = [1.7, 0.6]\n\
      [[rope]]\nmaterial = \"hemp\"\nfrom = [0.3, 1.9]\nto = [1.2, 1.9]\n",
    ),
    (
        "sleep",
        "spacing = 0.02\n[solver]\nsleep = true\n[[liquid]]\nname = \"water\"\n[[block]]\nmaterial = \"water\"\n\
      min = [0.0, 0.0]\nmax = [2.0, 1.0]\n[[tank]]\nmin = [0.0, 0.0]\nmax = [2.0, 2.0]\n",
    ),
    (
        "periodic",
        "spacing = 0.02\n[solver]\nsubsteps = 3\nsettle_substeps = 2\n[domain]\nperiodic_x = [0.0, 1.4]\n\
      periodic_y = [0.0, 1.4]\n[[liquid]]\nname = \"water\"\nsurface = \"none\"\n[[block]]\nmaterial = \"water\"\n\
      min = [0.0, 0.0]\nmax = [1.4, 1.4]\nvelocity = [1.0, 0.5]\njitter = 0.1\n",
    ),
    (
        "periodic grid",
        "spacing = 0.02\n[solver]\npressure_grid = \"on\"\n[domain]\nperiodic_x = [0.0, 1.4]\n[[liquid]]\n\
      name = \"water\"\n[[block]]\nmaterial = \"water\"\nmin = [0.0, 0.0]\nmax = [1.4, 1.4]\nvelocity = [1.0, 0.0]\n\
      jitter = 0.1\n[[half_plane]]\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n",
    ),
];

const LEVELS: [&str; 5] = ["scalar", "portable", "sse2", "avx2", "avx512"];

/// The hash of the state at the end; `None` where the machine has no such instruction set.
fn hash(place: &Place, level: &str, threads: &str) -> Option<String> {
    let arguments = ["run", "scene.toml", "--json", "-q", "--no-record", "--threads", threads, "--duration", "0.05"];
    let output = place.command(&arguments).env("UNIPBD_SIMD", level).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    if message.contains("instruction set of this machine") {
        assert_eq!(output.status.code(), Some(2));
        return None;
    }
    assert!(output.status.success(), "{level}: {message}");
    let text = String::from_utf8(output.stdout).unwrap();
    let summary: serde_json::Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    assert!(summary["counts_peak"].to_string().len() > 2);
    Some(summary["state_hash"].as_str().unwrap().to_owned())
}

#[test]
fn every_kind_of_scene_ends_in_the_same_state() {
    for (name, text) in SCENES {
        let place = Place::new();
        place.write("scene.toml", text);
        let reference = hash(&place, "scalar", "1").unwrap();
        let mut compared = 0;
        for (level, threads) in LEVELS.iter().zip(["2", "1", "2", "3", "2"]) {
            if let Some(found) = hash(&place, level, threads) {
                assert_eq!(found, reference, "{name}: {level} on {threads} threads");
                compared += 1;
            }
        }
        assert!(compared >= 2, "{name}: {compared} instruction sets");
    }
}

#[test]
fn an_unknown_instruction_set_is_refused() {
    let output = Place::new().command(&["drop.toml"]).env("UNIPBD_SIMD", "mmx").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("UNIPBD_SIMD") && message.contains("scalar") && message.contains("mmx"), "{message}");
}
