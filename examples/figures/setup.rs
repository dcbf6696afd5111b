//! Scenes at rest or in motion, cameras and sizes of all figures.

use glam::Vec3;
use strandline::{
    Backend, Camera, Hair, HeadMotion, Picture, PictureSettings, Pose, Prepared, Scene, Style,
    scene::{FilmSection, MotionName},
    settings::StrandMethod,
};

/// A finished figure, or why there is none.
pub type Figure = Result<Picture, Box<dyn std::error::Error>>;

/// Seconds between two moves of the head.
pub const FRAME: f64 = 1.0 / 60.0;

/// Settings of all figures.
pub struct Setup {
    /// Backend of simulation and pictures.
    pub backend: Backend,
    /// True for small pictures of few strands, a coarse body and short motions.
    pub quick: bool,
}

impl Setup {
    /// A style whose head moves as named.
    pub fn scene(&self, style: Style, motion: MotionName) -> Scene {
        let mut scene = Scene::demo();
        scene.set_style(style);
        scene.motion.name = motion;
        scene
    }

    /// Hair of a scene that rests on the head, with pictures of a size \[pixel\]: rods begin so, other strands
    /// come to hang first.
    pub fn settled(&self, scene: &Scene, width: u32, height: u32) -> Result<Moving, strandline::Error> {
        let mut scene = scene.clone();
        (scene.picture.width, scene.picture.height) = self.size(width, height);
        if self.quick {
            (scene.style.strand_count, scene.body.spacing) = (50, 0.02);
            scene.look.follow_strands = scene.look.follow_strands.min(8);
        }
        let mut hair = Hair::from_prepared(Prepared::new(&scene)?, self.backend)?;
        let head = hair.head().clone();
        if scene.simulation.strands.method == StrandMethod::Constrain && !self.quick {
            hair.step(FilmSection::SETTLE.into(), Pose::IDENTITY)?;
        }
        Ok(Moving { hair, head, picture: scene.picture, time: 0.0, held: None })
    }

    /// A style that rests on the head, with pictures of a size \[pixel\].
    pub fn resting(&self, style: Style, width: u32, height: u32) -> Result<Hair, strandline::Error> {
        Ok(self.settled(&self.scene(style, MotionName::Still), width, height)?.hair)
    }

    /// Duration \[s\] of a motion that takes a number of seconds in the figures.
    pub fn lasting(&self, seconds: f64) -> f64 {
        if self.quick { 0.1 * seconds } else { seconds }
    }

    /// The size \[pixel\] at which a picture is drawn.
    fn size(&self, width: u32, height: u32) -> (u32, u32) {
        if self.quick { (width / 5, height / 5) } else { (width, height) }
    }
}

/// Hair on a head that moves.
pub struct Moving {
    /// The hair.
    pub hair: Hair,
    /// Size and finish of its pictures.
    pub picture: PictureSettings,
    /// Time that passed \[s\].
    pub time: f64,
    /// Point \[m\] at which a hand holds hair; `None` if it holds none.
    pub held: Option<Vec3>,
    head: HeadMotion,
}

impl Moving {
    /// Lets the head move on to a time \[s\].
    pub fn play_to(&mut self, time: f64) -> Result<(), strandline::Error> {
        self.play_to_and_rest(time, f64::INFINITY)
    }

    /// The same, but the head stays where it is from a time \[s\] on.
    pub fn play_to_and_rest(&mut self, time: f64, rest: f64) -> Result<(), strandline::Error> {
        while self.time < time - 0.5 * FRAME {
            let (begin, head) = (self.time, &self.head);
            self.hair.step_along(FRAME, |share| head.pose((begin + FRAME * f64::from(share)).min(rest)))?;
            self.time += FRAME;
        }
        Ok(())
    }
}

/// The whole bust in a square picture, from a direction.
pub fn bust(direction: Vec3) -> Camera {
    close(direction, Vec3::new(0.0, -0.09, -0.05), 0.54)
}

/// Camera on `target` \[m\] from a direction, with a view `height` \[m\] high.
pub fn close(direction: Vec3, target: Vec3, height: f32) -> Camera {
    let camera = Camera { target, field_of_view: 25.0, ..Camera::front() };
    let position = target + direction.normalize() * (0.5 * height * camera.focal());
    Camera { position, ..camera }
}

/// From the front, a little to the head's left and above.
pub const THREE_QUARTER: Vec3 = Vec3::new(0.62, 0.14, 0.78);
