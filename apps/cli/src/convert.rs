//! `strandline convert`: a groom in another format, and with other strands.

use glam::{Quat, Vec3};
use strandline::file::counted;
use strandline::{
    Groom, Mesh,
    format::{self, Cleaning, LoadOptions, Scale},
    mesh::{DistanceGrid, SignedDistance},
};

use crate::arguments::{ConvertOptions, Usage};
use crate::progress::Waiting;
use crate::{files, output};

/// Distance between the samples of a mesh that strands are pushed out of, and air around it \[m\].
const SPACING: f32 = 0.002;
const AIR: f32 = 0.01;
/// Distance of roots from it, as a share of its size, beyond which a mesh is not theirs.
const APART: f32 = 0.1;

/// Reads files as one groom, changes it as requested, and writes it.
pub fn convert(options: &ConvertOptions) -> anyhow::Result<()> {
    // Options may stand between files, so that clap counts them one by one.
    let [inputs @ .., output] = &options.files[..] else { return Err(too_few().into()) };
    if inputs.is_empty() {
        return Err(too_few().into());
    }
    // An output that cannot be written is refused before anything is read.
    format::Format::of(output)?;
    let cleaning = if options.clean { Cleaning::All } else { Cleaning::Named };
    let reading = LoadOptions { cleaning, ..options.reading.options() };
    let loaded = format::load_all(inputs, &reading)?;
    for problem in &loaded.report.problems {
        output::note(problem);
    }
    let mut groom = loaded.groom;
    if let Some(count) = options.thin {
        let waiting = Waiting::begin("choosing strands");
        let chosen = groom.representatives(count as usize);
        let torn = groom.influences.as_ref().map_or(0, |influences| influences.torn_by(&chosen));
        groom = groom.select(&chosen);
        drop(waiting);
        if torn > 0 {
            output::note(&format!(
                "{} lost guides that were not kept: followed guides are left out",
                counted(torn, "strand has", "strands have")
            ));
        }
    }
    if let Some(points) = options.points {
        groom = groom.resampled(points as usize)?;
    }
    groom.transform(1.0, Quat::IDENTITY, options.translation.unwrap_or_default());
    if let Some(file) = &options.outside {
        let mut mesh = Mesh::load(file, 1.0)?;
        place(&mut mesh, &groom, options.mesh_scale);
        push_out(&mut groom, &mesh)?;
    }
    files::write(&groom, output)
}

fn too_few() -> Usage {
    Usage("convert has one file, expected IN... OUT: the files to read and the file to write".to_owned())
}

/// Scales a mesh to metres, and says so where that was not given; says where it does not meet the strands.
fn place(mesh: &mut Mesh, groom: &Groom, scale: Scale) {
    let given = match scale {
        Scale::Factor(unit) => Some(unit),
        Scale::Auto => None,
    };
    let (unit, apart) = strandline::mesh::mesh_unit(groom, mesh, given);
    mesh.positions.iter_mut().for_each(|position| *position *= unit);
    if given.is_none() && unit != 1.0 {
        output::note(&format!("a unit of the mesh is {unit} m; --mesh-scale says otherwise"));
    }
    if apart > APART {
        output::note(
            "the roots do not lie on the mesh: --scale, --up, --turn and --move place the strands, --mesh-scale the mesh",
        );
    }
}

/// Moves points inside a mesh to its surface.
fn push_out(groom: &mut Groom, mesh: &Mesh) -> anyhow::Result<()> {
    let waiting = Waiting::begin("pushing strands out of the mesh");
    let grid = DistanceGrid::of_mesh(mesh, SPACING, AIR)?;
    let found = groom.move_outside(|point: Vec3| grid.distance_and_gradient(point));
    drop(waiting);
    output::note(&format!(
        "{} of {} lay inside, by up to {:.2} mm: moved to the surface, {:.2} mm left at most",
        counted(found.point_count, "point", "points"),
        counted(found.strand_count, "strand", "strands"),
        1e3 * found.depth,
        1e3 * found.depth_left
    ));
    Ok(())
}
