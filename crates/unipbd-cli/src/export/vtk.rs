//! VTK XML PolyData, as ParaView reads it: one file of particles and one of bodies per frame, with a collection of each
//! that knows the times, and one file of walls. Numbers are raw little-endian blocks behind the XML ("VTK File Formats",
//! vtk.org).

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use unipbd_core::math::Vector64;
use unipbd_core::observe::WallOutline;
use unipbd_core::rigid::Body;

use super::{ExportError, Exporter, at, prepare_folder};
use crate::read::{Frame, Log};
use crate::record::outline_to_draw;

const PARTICLES: &str = "particles.pvd";
const BODIES: &str = "bodies.pvd";
const WALLS: &str = "walls.vtp";

/// Files in a folder.
pub struct Vtk {
    folder: PathBuf,
    written: Vec<PathBuf>,
    /// Times and names of the files of a collection.
    particles: Vec<(f64, String)>,
    bodies: Vec<(f64, String)>,
}

impl Vtk {
    /// Starts the files, and writes the walls.
    pub fn new(folder: &Path, replace: bool, log: &Log) -> Result<Self, ExportError> {
        prepare_folder(folder, &[PARTICLES, BODIES, WALLS], replace)?;
        let mut files =
            Vtk { folder: folder.to_owned(), written: Vec::new(), particles: Vec::new(), bodies: Vec::new() };
        let walls = &log.setting().walls;
        if !walls.is_empty() {
            files.write(WALLS, &walls_file(walls))?;
        }
        Ok(files)
    }

    fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        let path = self.folder.join(name);
        fs::write(&path, bytes).map_err(at(&path))?;
        self.written.push(path);
        Ok(())
    }
}

impl Exporter for Vtk {
    fn add(&mut self, number: u64, frame: &Frame) -> Result<(), ExportError> {
        let time = frame.snapshot.time;
        let name = format!("particles_{number:06}.vtp");
        self.write(&name, &particles_file(frame))?;
        self.particles.push((time, name));
        if !frame.snapshot.bodies.is_empty() {
            let name = format!("bodies_{number:06}.vtp");
            self.write(&name, &bodies_file(&frame.snapshot.bodies))?;
            self.bodies.push((time, name));
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<Vec<PathBuf>, ExportError> {
        let collections =
            [(PARTICLES, std::mem::take(&mut self.particles)), (BODIES, std::mem::take(&mut self.bodies))];
        for (name, files) in collections.into_iter().filter(|(_, files)| !files.is_empty()) {
            self.write(name, collection(&files).as_bytes())?;
        }
        self.written.reverse();
        Ok(self.written)
    }
}

fn collection(files: &[(f64, String)]) -> String {
    let mut text =
        String::from("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n");
    for (time, name) in files {
        let _ = writeln!(text, "<DataSet timestep=\"{time}\" file=\"{name}\"/>");
    }
    text + "</Collection>\n</VTKFile>\n"
}

/// A file of points, and of lines or polygons through them.
#[derive(Default)]
struct PolyData {
    points: Vec<[f32; 3]>,
    point_data: String,
    cell_data: String,
    blocks: Vec<u8>,
}

impl PolyData {
    /// Adds a block of numbers and describes it.
    fn array(&mut self, kind: &str, name: &str, components: usize, bytes: &[u8]) -> String {
        let offset = self.blocks.len();
        self.blocks.extend((bytes.len() as u64).to_le_bytes());
        self.blocks.extend(bytes);
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
             offset=\"{offset}\"/>\n"
        )
    }

    fn point_floats(&mut self, name: &str, components: usize, values: impl Iterator<Item = f32>) {
        let bytes: Vec<u8> = values.flat_map(f32::to_le_bytes).collect();
        let array = self.array("Float32", name, components, &bytes);
        self.point_data += &array;
    }

    fn point_integers(&mut self, name: &str, values: impl Iterator<Item = i32>) {
        let bytes: Vec<u8> = values.flat_map(i32::to_le_bytes).collect();
        let array = self.array("Int32", name, 1, &bytes);
        self.point_data += &array;
    }

    fn cell_floats(&mut self, name: &str, components: usize, values: impl Iterator<Item = f32>) {
        let bytes: Vec<u8> = values.flat_map(f32::to_le_bytes).collect();
        let array = self.array("Float32", name, components, &bytes);
        self.cell_data += &array;
    }

    /// The file; `cells` are the ends of runs of `order`, each a cell of this kind: Verts, Lines or Polys.
    fn file(mut self, kind: &str, order: &[i32], ends: &[i32]) -> Vec<u8> {
        let points: Vec<u8> = self.points.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let points = self.array("Float32", "Points", 3, &points);
        let order: Vec<u8> = order.iter().flat_map(|value| value.to_le_bytes()).collect();
        let connectivity = self.array("Int32", "connectivity", 1, &order);
        let count = ends.len();
        let ends: Vec<u8> = ends.iter().flat_map(|value| value.to_le_bytes()).collect();
        let offsets = self.array("Int32", "offsets", 1, &ends);
        let head = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOf{kind}=\"{count}\">\n\
             <PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n<Points>\n{points}</Points>\n\
             <{kind}>\n{connectivity}{offsets}</{kind}>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
            self.points.len(),
            self.point_data,
            self.cell_data
        );
        let mut file = head.into_bytes();
        file.extend(self.blocks);
        file.extend(b"\n</AppendedData>\n</VTKFile>\n");
        file
    }
}

fn particles_file(frame: &Frame) -> Vec<u8> {
    let snapshot = &frame.snapshot;
    let mut data =
        PolyData { points: snapshot.positions.iter().map(|&[x, y]| [x, y, 0.0]).collect(), ..PolyData::default() };
    data.point_integers("id", snapshot.ids.iter().map(|id| *id as i32));
    data.point_integers("phase", snapshot.phases.iter().map(|phase| *phase as i32));
    data.point_integers("material", snapshot.materials.iter().map(|material| i32::from(*material)));
    if let Some(velocities) = &snapshot.velocities {
        data.point_floats("velocity", 3, velocities.iter().flat_map(|&[x, y]| [x, y, 0.0]));
    }
    if let Some(errors) = &snapshot.density_errors {
        data.point_floats("density_error", 1, errors.iter().copied());
    }
    if let Some(temperatures) = &snapshot.temperatures {
        data.point_floats("temperature", 1, temperatures.iter().copied());
    }
    let count = snapshot.positions.len() as i32;
    let order: Vec<i32> = (0..count).collect();
    let ends: Vec<i32> = (1..=count).collect();
    data.file("Verts", &order, &ends)
}

fn bodies_file(bodies: &[Body]) -> Vec<u8> {
    let there: Vec<&Body> = bodies.iter().filter(|body| !body.removed).collect();
    let (mut data, mut ends) = (PolyData::default(), Vec::new());
    for body in &there {
        let turn = Vector64::from_angle(body.angle);
        let corners = outline_to_draw(body).into_iter().map(|corner| body.position + turn.rotate(corner));
        data.points.extend(corners.map(|corner| [corner.x as f32, corner.y as f32, 0.0]));
        ends.push(data.points.len() as i32);
    }
    let vector =
        |of: fn(&Body) -> Vector64| there.iter().map(move |body| of(body)).flat_map(|v| [v.x as f32, v.y as f32, 0.0]);
    data.cell_floats("velocity", 3, vector(|body| body.velocity));
    data.cell_floats("fluid_force", 3, vector(|body| body.fluid_force));
    data.cell_floats("contact_force", 3, vector(|body| body.contact_force));
    data.cell_floats("angle", 1, there.iter().map(|body| body.angle as f32));
    data.cell_floats("angular_velocity", 1, there.iter().map(|body| body.angular_velocity as f32));
    data.cell_floats("mass", 1, there.iter().map(|body| body.mass as f32));
    let order: Vec<i32> = (0..data.points.len() as i32).collect();
    data.file("Polys", &order, &ends)
}

fn walls_file(walls: &[WallOutline]) -> Vec<u8> {
    let (mut data, mut order, mut ends) = (PolyData::default(), Vec::new(), Vec::new());
    for wall in walls {
        let first = data.points.len() as i32;
        data.points.extend(wall.points.iter().map(|point| [point.x as f32, point.y as f32, 0.0]));
        order.extend(first..data.points.len() as i32);
        order.extend(wall.closed.then_some(first));
        ends.push(order.len() as i32);
    }
    data.file("Lines", &order, &ends)
}
