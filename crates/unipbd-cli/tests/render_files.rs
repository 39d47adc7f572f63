//! Files hold what was drawn, and nothing is replaced unasked.

use std::path::{Path, PathBuf};

use unipbd_cli::render::encode::{GifOptions, GifWriter, write_png};
use unipbd_cli::render::{
    Existing, Image, Output, RenderError, RenderJob, RenderOptions, Rendered, Renderer, plan_output, run,
};
use unipbd_cli::snapshot::{Setting, Snapshot};
use unipbd_core::observe::Material;
use unipbd_core::phase::Phase;

fn setting() -> Setting {
    let water = Material { name: "water".into(), phase: Phase::Liquid, density: 1.0, color: [40, 120, 220] };
    Setting {
        name: "test".into(),
        spacing: 0.1,
        materials: vec![water],
        walls: vec![],
        view: Some(([0.0; 2], [1.0; 2])),
    }
}

/// A drop that crosses the picture in a second.
fn frame(time: f64) -> Snapshot {
    Snapshot {
        time,
        positions: vec![[time as f32, 0.5]],
        ids: vec![0],
        phases: vec![Phase::Liquid],
        materials: vec![0],
        ..Snapshot::default()
    }
}

fn frames() -> impl Iterator<Item = Result<Snapshot, RenderError>> {
    (0..=60).map(|k| Ok(frame(f64::from(k) / 60.0)))
}

fn job(output: PathBuf) -> RenderJob {
    let mut job = RenderJob::new(output);
    job.options.width = 96;
    job
}

fn render(job: &RenderJob) -> Result<Rendered, RenderError> {
    run(frames(), &setting(), job, |_| {})
}

fn picture(time: f64) -> Image {
    Renderer::new(&setting(), RenderOptions { width: 96, ..RenderOptions::default() })
        .draw(&frame(time))
        .unwrap()
        .clone()
}

fn read_png(path: &Path) -> Vec<u8> {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes
}

/// Every picture a viewer shows, and its delay in hundredths of a second.
fn read_gif(path: &Path) -> Vec<(Vec<[u8; 3]>, u16)> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(std::fs::File::open(path).unwrap()).unwrap();
    let width = usize::from(decoder.width());
    let mut screen = vec![[0; 3]; width * usize::from(decoder.height())];
    let mut shown = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        for (k, pixel) in frame.buffer.chunks_exact(4).enumerate().filter(|(_, pixel)| pixel[3] > 0) {
            let [x, y] = [k % usize::from(frame.width), k / usize::from(frame.width)];
            screen[(y + usize::from(frame.top)) * width + x + usize::from(frame.left)] = [pixel[0], pixel[1], pixel[2]];
        }
        shown.push((screen.clone(), frame.delay));
    }
    shown
}

#[test]
fn a_png_reads_back_as_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    write_png(&path, &picture(0.3), "").unwrap();
    assert_eq!(read_png(&path), picture(0.3).to_rgb());
}

#[test]
fn one_picture_shows_the_last_frame_or_the_one_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path().join("a.png"));
    assert_eq!(render(&job).unwrap().frames, 1);
    assert_eq!(read_png(&job.output), picture(1.0).to_rgb());
    job.existing = Existing::Replace;
    job.selection.time = Some(0.4999);
    render(&job).unwrap();
    assert_eq!(read_png(&job.output), picture(0.5).to_rgb());
}

#[test]
fn numbered_pictures_and_directories_hold_one_file_a_frame() {
    let folder = tempfile::tempdir().unwrap();
    let mut numbered = job(folder.path().join("new/f_%03d.png"));
    numbered.selection.every = Some(20);
    let done = render(&numbered).unwrap();
    assert_eq!((done.frames, done.size), (4, [96, 96]));
    assert_eq!(read_png(&folder.path().join("new/f_002.png")), picture(40.0 / 60.0).to_rgb());
    assert!(!folder.path().join("new/f_004.png").exists());
    let directory = job(folder.path().to_owned());
    assert_eq!(render(&directory).unwrap().frames, 61);
    assert!(folder.path().join("frame_0060.png").exists());
}

#[test]
fn a_gif_reads_back_at_25_frames_a_second_with_no_trails() {
    let folder = tempfile::tempdir().unwrap();
    let job = job(folder.path().join("a.gif"));
    let done = render(&job).unwrap();
    assert_eq!((done.frames, done.fps), (26, Some(25.0)));
    let shown = read_gif(&job.output);
    assert_eq!(shown.len(), 26);
    assert!(shown.iter().all(|(_, delay)| *delay == 4));
    let last = picture(1.0);
    let drawn = last.to_rgb();
    let wrong = shown[25]
        .0
        .iter()
        .zip(drawn.chunks_exact(3))
        .map(|(seen, drawn)| seen.iter().zip(drawn).map(|(a, b)| a.abs_diff(*b)).max().unwrap());
    assert!(wrong.max().unwrap() <= 24);
    assert_eq!(shown[25].0[48 * 96 + 10], last.pixel(10, 48).unwrap(), "the drop has left a trail");
}

#[test]
fn gif_delays_add_up_to_the_length_of_the_film() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    let mut writer = GifWriter::new(&path, 24.0, GifOptions::default());
    (0..48).for_each(|k| writer.push(&picture(f64::from(k) / 48.0)).unwrap());
    writer.finish().unwrap();
    assert_eq!(read_gif(&path).iter().map(|(_, delay)| u64::from(*delay)).sum::<u64>(), 200);
}

#[test]
fn a_gif_that_stands_still_is_as_long_as_one_that_moves() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    let mut writer = GifWriter::new(&path, 10.0, GifOptions::default());
    (0..5).for_each(|_| writer.push(&picture(0.5)).unwrap());
    writer.finish().unwrap();
    assert_eq!(read_gif(&path).iter().map(|(_, delay)| *delay).collect::<Vec<_>>(), [10; 5]);
}

#[test]
fn a_gif_is_squeezed_into_its_size_limit_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path().join("a.gif"));
    render(&job).unwrap();
    let free = std::fs::metadata(&job.output).unwrap().len();
    job.existing = Existing::Replace;
    job.gif.size_limit = Some(free * 2 / 3);
    render(&job).unwrap();
    assert!(std::fs::metadata(&job.output).unwrap().len() <= free * 2 / 3);
    job.gif.size_limit = Some(100);
    assert!(matches!(render(&job), Err(RenderError::GifSize { limit: 100 })));
}

#[test]
fn nothing_is_replaced_unless_asked_to() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.gif", "a.mp4", "a_0002.png"] {
        std::fs::write(folder.path().join(name), "precious").unwrap();
    }
    for name in ["a.png", "a.gif", "a.mp4", "a_%04d.png"] {
        let error = render(&job(folder.path().join(name))).unwrap_err();
        assert!(matches!(error, RenderError::Exists(_)), "{error}");
        assert!(error.to_string().contains("--force"));
    }
    for name in ["a.png", "a.gif", "a.mp4", "a_0002.png"] {
        assert_eq!(std::fs::read(folder.path().join(name)).unwrap(), b"precious");
    }
}

#[test]
fn outputs_are_told_by_their_names() {
    assert_eq!(plan_output(Path::new("x.PNG")).unwrap(), Output::Picture("x.PNG".into()));
    assert_eq!(plan_output(Path::new("x.gif")).unwrap(), Output::Gif("x.gif".into()));
    let Output::Pictures(names) = plan_output(Path::new("some/where/")).unwrap() else { panic!() };
    assert_eq!(names.path(7), Path::new("some/where/frame_0007.png"));
    let Output::Pictures(names) = plan_output(Path::new("a%d.png")).unwrap() else { panic!() };
    assert_eq!(names.path(12), Path::new("a12.png"));
    for bad in ["x.jpg", "x", "x.png.txt", "a%s.png", "a%04d_%04d.png", ".gif/x", "a%.png"] {
        let error = plan_output(Path::new(bad)).unwrap_err();
        assert!(error.to_string().contains("NAME_%04d.png"), "{bad}: {error}");
    }
}

#[test]
fn senseless_jobs_and_empty_spans_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let change = |change: &dyn Fn(&mut RenderJob)| {
        let mut job = job(folder.path().join("a.gif"));
        change(&mut job);
        render(&job).unwrap_err()
    };
    assert!(matches!(change(&|job| job.speed = 0.0), RenderError::Job(_)));
    assert!(matches!(change(&|job| job.selection.every = Some(0)), RenderError::Job(_)));
    assert!(matches!(
        change(&|job| (job.selection.from, job.selection.to) = (Some(2.0), Some(1.0))),
        RenderError::Job(_)
    ));
    assert!(matches!(change(&|job| job.selection.from = Some(9.0)), RenderError::NoFrames));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn an_unreadable_frame_ends_the_job_with_its_message() {
    let folder = tempfile::tempdir().unwrap();
    let broken =
        frames().take(5).map(|frame| frame.map_err(|error| error.to_string())).chain([Err("log is torn".into())]);
    let error = run(broken, &setting(), &job(folder.path().join("a.gif")), |_| {}).unwrap_err();
    assert_eq!(error.to_string(), "log is torn");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_folder_that_does_not_exist_is_named() {
    let error = render(&job("/nonexistent/folder/a.gif".into())).unwrap_err();
    assert!(error.to_string().contains("/nonexistent/folder"), "{error}");
}

#[test]
fn mp4_without_ffmpeg_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path().join("a.mp4"));
    job.ffmpeg = "no-such-ffmpeg".into();
    let error = render(&job).unwrap_err();
    assert!(matches!(error, RenderError::NoFfmpeg(_)));
    assert!(error.to_string().contains("install ffmpeg"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A stand-in for `ffmpeg` as a shell script; its last argument is the file to write.
#[cfg(unix)]
fn stand_in(folder: &Path, script: &str) -> PathBuf {
    let [text, program] = ["script", "ffmpeg"].map(|name| folder.join(name));
    std::fs::write(&text, format!("#!/bin/sh\n{script}\n")).unwrap();
    // A file that any thread has open for writing cannot be run: let another process write it.
    let install = std::process::Command::new("install").args(["-m", "755"]).args([&text, &program]).status();
    assert!(install.unwrap().success());
    program
}

#[cfg(unix)]
#[test]
fn mp4_frames_reach_ffmpeg_whole_and_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path().join("a.mp4"));
    job.ffmpeg = stand_in(folder.path(), r#"for last; do :; done; cat > "$last"; echo "$@" > "$0.arguments""#);
    let done = render(&job).unwrap();
    assert_eq!(done.frames, 61);
    let raw = std::fs::read(&job.output).unwrap();
    assert_eq!(raw.len(), 61 * 96 * 96 * 4);
    assert_eq!(&raw[60 * 96 * 96 * 4..], picture(1.0).rgba());
    let arguments = std::fs::read_to_string(folder.path().join("ffmpeg.arguments")).unwrap();
    assert!(arguments.contains("-video_size 96x96 -framerate 60.0000"), "{arguments}");
    assert!(!folder.path().join("a.mp4.partial").exists());
}

#[cfg(unix)]
#[test]
fn a_failing_ffmpeg_is_quoted_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job(folder.path().join("a.mp4"));
    job.ffmpeg = stand_in(folder.path(), r#"for last; do :; done; echo x > "$last"; echo "no such codec" >&2; exit 1"#);
    let error = render(&job).unwrap_err();
    assert_eq!(error.to_string(), "ffmpeg failed: no such codec");
    assert!(!job.output.exists() && !folder.path().join("a.mp4.partial").exists());
}
