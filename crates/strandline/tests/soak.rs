//! Ten thousand pictures of small hair, while everything is changed that can be changed, at random.

use std::path::Path;
use std::time::{Duration, Instant};

use glam::{Vec2, Vec3};
use strandline::scene::{MotionName, MotionSection, WindSection};
use strandline::{Backend, Camera, Command, Light, Live, News, Picture, Ray, Scene, Shown, body};

const PICTURES: u64 = 10_000;
/// So often everything is set back and compared.
const CHECK: u64 = 1250;

/// Hair that takes next to no time.
fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 20;
    scene.body.model = strandline::scene::Model::None;
    scene.groom.points_per_strand = 6;
    scene.simulation.volume.cells = [8; 3];
    scene.simulation.iterations = 8;
    (scene.simulation.backend, scene.picture.backend) = (Backend::Cpu, Backend::Cpu);
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 60.0);
    scene.look.shadow.map_size = 32;
    (scene.picture.width, scene.picture.height) = (32, 24);
    scene
}

struct Player {
    live: Live,
    random: body::Random,
    told: u64,
    last: Shown,
    /// Commands that cannot be done, and errors that came.
    refused: u64,
    errors: u64,
    loaded: u64,
}

impl Player {
    fn tell(&mut self, command: Command) {
        self.told = self.live.tell(command);
    }

    fn share(&mut self) -> f32 {
        self.random.unit()
    }

    fn below(&mut self, count: u32) -> u32 {
        (self.share() * count as f32) as u32
    }

    fn take_news(&mut self) {
        for news in self.live.take_news() {
            match news {
                News::Loaded(number, ..) => self.loaded = number,
                News::Error(_) => self.errors += 1,
                News::Paused => panic!("it stopped by itself"),
                _ => {}
            }
        }
    }

    /// Waits for what is wanted, for at most a minute: nothing else would tell a deadlock.
    fn wait(&mut self, wanted: impl Fn(&Self) -> bool) {
        let begin = Instant::now();
        while !wanted(self) {
            self.take_news();
            if let Some(shown) = self.live.take_shown() {
                assert!(shown.frame > self.last.frame, "pictures come in their order");
                assert!(shown.heard >= self.last.heard && shown.heard <= self.told);
                assert_eq!(shown.picture.pixels.len() as u32, 3 * shown.picture.width * shown.picture.height);
                self.last = shown;
            } else {
                assert!(
                    begin.elapsed() < Duration::from_secs(60),
                    "nothing came: picture {}, {} of {} heard",
                    self.last.frame,
                    self.last.heard,
                    self.told
                );
                std::thread::sleep(Duration::from_micros(100));
            }
        }
    }

    /// Does something that a person may do.
    fn act(&mut self, bad_groom: &Path) {
        let (base, share, other) = (scene(), self.share(), self.share());
        let ray = Ray::new(&Camera::front(), Vec2::new(share - 0.5, other - 0.5));
        let mut settings = base.simulation.clone();
        let command = match self.below(24) {
            0 => Command::Camera(Camera::front().orbit(6.0 * share, other - 0.5)),
            1 => Command::Look(Box::new(strandline::Look {
                follow_strands: 1 + (9.0 * share) as u32,
                ..base.look
            })),
            2 => Command::BodyLook(base.body_look),
            3 => Command::Lights(Light::three_point(Vec3::splat(share))[..(4.0 * other) as usize].to_vec()),
            4 => Command::LevelOfDetail(strandline::render::LevelOfDetail {
                segments_per_span: 1 + (4.0 * share) as u32,
                ..base.level_of_detail
            }),
            5 => {
                // Now and then large: the side that draws is the slow one.
                let (width, height) = if share < 0.1 { (400, 300) } else { (16 + (60.0 * share) as u32, 24) };
                Command::Picture(strandline::render::PictureSettings { width, height, ..base.picture })
            }
            6 => {
                // Likewise the side that simulates.
                settings.iterations = if share < 0.2 { 2000 } else { 1 + (20.0 * share) as u32 };
                settings.volume.enabled = other < 0.5;
                Command::Settings(Box::new(settings))
            }
            7 => {
                settings.time_step = [1.0 / 120.0, 1.0 / 60.0, 1.0 / 30.0][(3.0 * share) as usize];
                Command::Settings(Box::new(settings))
            }
            8 => Command::Length(0.05 + 0.95 * share),
            9 => Command::Wind(WindSection { velocity: Vec3::X * 8.0 * share, ..WindSection::default() }),
            10 => {
                let name = [MotionName::Still, MotionName::Shake, MotionName::Nod, MotionName::Turn]
                    [(4.0 * share) as usize];
                Command::Motion(Box::new(MotionSection { name, ..MotionSection::default() }))
            }
            11 => Command::Motion(Box::new(MotionSection {
                rotation: Vec3::new(0.0, 60.0 * (share - 0.5), 0.0),
                ..MotionSection::default()
            })),
            12 | 13 => Command::Grab(ray, 0.1 * share),
            14..=16 => Command::Drag(ray),
            17 => Command::Release,
            18 => Command::Reset,
            19 => Command::Adapt(share < 0.5),
            20 => {
                self.tell(Command::Play(false));
                for _ in 0..(4.0 * share) as u32 {
                    self.tell(Command::Step);
                }
                Command::Play(true)
            }
            21 if share < 0.1 => Command::Load(Box::new(base)),
            21 if share < 0.2 => {
                let mut bad = base;
                bad.groom.file = Some(bad_groom.to_owned());
                Command::Load(Box::new(bad))
            }
            22 => {
                settings.iterations = 0;
                self.refused += 1;
                Command::Settings(Box::new(settings))
            }
            23 => {
                self.refused += 1;
                match (4.0 * share) as u32 {
                    0 => Command::Length(1.5),
                    1 => Command::Camera(Camera { field_of_view: f32::NAN, ..Camera::front() }),
                    2 => Command::Wind(WindSection { gust: 7.0, ..WindSection::default() }),
                    _ => Command::Picture(strandline::render::PictureSettings { width: 0, ..base.picture }),
                }
            }
            _ => {
                std::thread::sleep(Duration::from_millis((10.0 * share) as u64));
                Command::Drag(ray)
            }
        };
        self.tell(command);
    }

    /// Sets everything back; the picture at rest and the one some steps later.
    fn set_back(&mut self) -> [Picture; 2] {
        let base = scene();
        let light = Light::three_point(Vec3::ZERO).to_vec();
        for command in [
            Command::Play(false),
            Command::Release,
            Command::Adapt(false),
            Command::Settings(Box::new(base.simulation.clone())),
            Command::Length(1.0),
            Command::Wind(base.wind),
            // One that it cannot be at.
            Command::Motion(Box::new(MotionSection { name: MotionName::Turn, ..base.motion.clone() })),
            Command::Motion(Box::new(base.motion.clone())),
            Command::Look(Box::new(base.look.clone())),
            Command::BodyLook(base.body_look),
            Command::Lights(light),
            Command::LevelOfDetail(base.level_of_detail),
            Command::Picture(base.picture),
            Command::Camera(Camera::front()),
            Command::Reset,
        ] {
            self.tell(command);
        }
        self.wait(|player| player.last.heard == player.told);
        let rest = self.last.picture.clone();
        // A step at a time: of several told at once only the last may be seen.
        for _ in 0..20 {
            self.tell(Command::Step);
            self.wait(|player| player.last.heard == player.told);
        }
        [rest, self.last.picture.clone()]
    }
}

/// The largest difference of two pictures' bytes.
fn apart(a: &Picture, b: &Picture) -> u8 {
    assert_eq!([a.width, a.height], [b.width, b.height]);
    a.pixels.iter().zip(&b.pixels).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

#[test]
fn ten_thousand_pictures_with_changes_at_random() {
    let folder = tempfile::tempdir().unwrap();
    let bad_groom = folder.path().join("bad.hair");
    std::fs::write(&bad_groom, b"PK nothing").unwrap();
    let live = Live::new(scene(), || ()).unwrap();
    let random = body::Random::new(5, 0);
    let last = Shown::default();
    let mut player = Player { live, random, told: 1, last, refused: 0, errors: 0, loaded: 0 };
    player.wait(|player| player.last.frame > 0);
    let first = player.set_back();
    assert!(apart(&first[0], &first[1]) > 20, "nothing moves: {}", apart(&first[0], &first[1]));
    player.tell(Command::Play(true));
    let mut checked = 0;
    while player.last.frame < PICTURES {
        player.act(&bad_groom);
        let (seen, wait) = (player.last.frame, u64::from(player.below(3)));
        // The window may be the slow one.
        std::thread::sleep(Duration::from_micros(100 * u64::from(player.below(8))));
        player.wait(|player| player.last.frame >= seen + wait);
        if player.last.frame / CHECK > checked {
            checked = player.last.frame / CHECK;
            let now = player.set_back();
            assert_eq!(apart(&now[0], &first[0]), 0, "at rest it is what it was");
            assert_eq!(apart(&now[1], &first[1]), 0, "it moves as it did the first time");
            assert_eq!(player.errors, player.refused, "what is refused is told once, and nothing else");
            player.tell(Command::Play(true));
        }
    }
    assert_eq!(checked, PICTURES / CHECK);
}
