//! Thousands of pictures of small hair, while all that a person may change is changed at random.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use glam::{Vec2, Vec3};
use strandline::{
    Backend, Camera, Change, Event, Light, Live, Look, Picture, PictureSettings, Ray, Scene,
    live::{Command, LiveEvent, Shown},
    look::{BodyLook, LevelOfDetail, fibre::FibreModel},
    low_level::body,
    scene::{Model, MotionName, MotionSection, WindSection},
};

/// Pictures of the whole test, and of its short form.
const PICTURES: [u64; 2] = [10_000, 2500];
/// So often everything is set back and compared.
const CHECK: u64 = 1250;

/// Hair that takes next to no time.
fn scene() -> Scene {
    let mut scene = Scene::demo();
    scene.style.strand_count = 20;
    scene.body.model = Model::None;
    scene.groom.points_per_strand = 6;
    scene.simulation.volume.cells = [8; 3];
    scene.simulation.strands.constrain.iterations = 8;
    (scene.devices.simulation, scene.devices.pictures) = (Backend::Cpu, Backend::Cpu);
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 60.0);
    scene.look.shadow.map_size = 32;
    // The grid that carries scattered light takes as long for twenty strands as for many.
    scene.look.fibre.model = FibreModel::Scheuermann;
    scene.lights = Light::three_point(Vec3::ZERO).to_vec();
    let camera = Camera::front();
    (scene.camera.position, scene.camera.target) = (Some(camera.position), Some(camera.target));
    scene.camera.field_of_view = Some(camera.field_of_view);
    (scene.picture.width, scene.picture.height) = (32, 24);
    scene
}

struct Person {
    live: Live,
    random: body::Random,
    folder: PathBuf,
    sent: u64,
    last: Shown,
    /// Commands that cannot be done, and errors that came.
    refused: u64,
    errors: u64,
    /// Numbers of the last load that can be done, and of the last that was.
    load: u64,
    loaded: u64,
    loads: u64,
    saves: u64,
    saved: u64,
}

impl Person {
    fn new(folder: PathBuf) -> Self {
        Self {
            live: Live::new(scene(), || ()).unwrap(),
            random: body::Random::new(5, 0),
            folder,
            sent: 1,
            last: Shown::default(),
            refused: 0,
            errors: 0,
            load: 1,
            loaded: 0,
            loads: 0,
            saves: 0,
            saved: 0,
        }
    }

    fn tell(&mut self, command: impl Into<Command>) {
        self.sent = self.live.send(command);
    }

    /// Tells what has to be refused.
    fn refuse(&mut self, command: impl Into<Command>) {
        self.refused += 1;
        self.tell(command);
    }

    fn share(&mut self) -> f32 {
        self.random.unit()
    }

    fn below(&mut self, count: u32) -> u32 {
        (self.share() * count as f32) as u32
    }

    fn take_events(&mut self) {
        for news in self.live.take_events() {
            match news {
                LiveEvent::Loaded(number, ..) => {
                    (self.loaded, self.loads) = (number, self.loads + 1);
                }
                LiveEvent::NotLoaded(_, _, error) => assert!(error.contains("bad.hair"), "{error}"),
                LiveEvent::Error(_, error) if error.contains("save again") => self.saved += 1,
                LiveEvent::Error(_, error) => {
                    // Of all that it does only settings outside their ranges may be refused.
                    assert!(error.contains(", expected "), "{error}");
                    assert!(!error.contains("cannot"), "{error}");
                    self.errors += 1;
                }
                LiveEvent::Saved(_) => self.saved += 1,
                LiveEvent::Paused => panic!("it stopped by itself"),
                LiveEvent::Loading(..)
                | LiveEvent::Note(_)
                | LiveEvent::Recorded
                | LiveEvent::Saving(_)
                | LiveEvent::Exported(_)
                | LiveEvent::Touched(_) => {}
            }
        }
    }

    /// Waits for what is wanted, for at most a minute: nothing else would tell a deadlock.
    fn wait(&mut self, wanted: impl Fn(&Self) -> bool) {
        let begin = Instant::now();
        loop {
            let shown = self.live.take_shown();
            // Commands before a picture act before it.
            self.take_events();
            let came = shown.is_some();
            if let Some(shown) = shown {
                assert!(shown.frame > self.last.frame, "pictures come in their order");
                assert!(
                    shown.drawn_after_command >= self.last.drawn_after_command
                        && shown.drawn_after_command <= self.sent
                );
                let Picture { width, height, pixels, .. } = &shown.picture;
                assert_eq!(pixels.len() as u32, 3 * width * height);
                self.last = shown;
            }
            if wanted(self) {
                return;
            }
            let Shown { frame, drawn_after_command: drawn, .. } = self.last;
            let waited = begin.elapsed();
            assert!(waited.as_secs() < 60, "nothing came: picture {frame}, {drawn} of {} drawn", self.sent);
            if !came {
                std::thread::sleep(Duration::from_micros(100));
            }
        }
    }

    /// Changes what is drawn and how.
    fn look_around(&mut self) {
        let (base, share, other) = (scene(), self.share(), self.share());
        let change = match self.below(7) {
            0 => Change::Camera(Camera::front().orbit(6.0 * share, other - 0.5)),
            1 => Change::Look(Box::new(Look { follow_strands: 1 + (9.0 * share) as u32, ..base.look })),
            2 => Change::BodyLook(BodyLook { color: Vec3::splat(share), ..base.body_look }),
            3 => Change::Lights(Light::three_point(Vec3::splat(share))[..(4.0 * other) as usize].to_vec()),
            4 => {
                let segments_per_span = 1 + (4.0 * share) as u32;
                Change::LevelOfDetail(LevelOfDetail { segments_per_span, ..base.level_of_detail })
            }
            5 => {
                // Now and then large: the side that draws is the slow one.
                let (width, height) = if share < 0.1 { (400, 300) } else { (16 + (60.0 * share) as u32, 24) };
                Change::Picture(PictureSettings { width, height, ..base.picture })
            }
            _ => {
                self.tell(Command::Adapt(share < 0.5));
                return;
            }
        };
        self.tell(change);
    }

    /// Changes how hair and head move.
    fn meddle(&mut self) {
        let (share, other) = (self.share(), self.share());
        let mut settings = scene().simulation;
        let command = match self.below(6) {
            0 => {
                // Now and then the side that simulates is the slow one.
                settings.strands.constrain.iterations =
                    if share < 0.2 { 2000 } else { 1 + (20.0 * share) as u32 };
                settings.volume.enabled = other < 0.5;
                Change::Settings(Box::new(settings))
            }
            1 => {
                settings.time_step = [1.0 / 120.0, 1.0 / 60.0, 1.0 / 30.0][(3.0 * share) as usize];
                Change::Settings(Box::new(settings))
            }
            2 => Change::Length(0.05 + 1.95 * share),
            3 => Change::Wind(WindSection { velocity: Vec3::X * 8.0 * share, ..WindSection::default() }),
            4 => {
                let names = [MotionName::Still, MotionName::Shake, MotionName::Nod, MotionName::Turn];
                let name = names[(4.0 * share) as usize];
                Change::Motion(Box::new(MotionSection { name, ..MotionSection::default() }))
            }
            _ => {
                let rotation = Vec3::new(0.0, 60.0 * (share - 0.5), 0.0);
                Change::Motion(Box::new(MotionSection { rotation, ..MotionSection::default() }))
            }
        };
        self.tell(command);
    }

    /// Pulls at the hair.
    fn pull(&mut self) {
        let (share, other) = (self.share(), self.share());
        let ray = Ray::new(&Camera::front(), Vec2::new(share - 0.5, other - 0.5));
        let command = match self.below(6) {
            0 | 1 => Change::Grab(ray, 0.1 * share),
            2..=4 => Change::Drag(ray),
            _ => Change::Release,
        };
        self.tell(command);
    }

    /// Plays, steps, loads and saves.
    fn play(&mut self) {
        let share = self.share();
        match self.below(5) {
            0 => self.tell(Change::Reset),
            1 => {
                self.tell(Command::Play(false));
                (0..(4.0 * share) as u32).for_each(|_| self.tell(Command::Step));
                self.tell(Command::Play(true));
            }
            2 if share < 0.1 => {
                self.tell(Command::Load(Box::new(scene())));
                self.load = self.sent;
            }
            2 if share < 0.2 => {
                let mut bad = scene();
                bad.groom.file = Some(self.folder.join("bad.hair"));
                self.tell(Command::Load(Box::new(bad)));
                // It is the last one that counts.
                self.load = self.loaded;
            }
            3 if share < 0.2 => self.save("any.toml"),
            3 if share < 0.25 => {
                let folder = self.folder.join(format!("film{}", self.sent));
                self.tell(Command::Record(folder));
                self.tell(Command::Step);
                self.tell(Command::StopRecording);
            }
            _ => std::thread::sleep(Duration::from_millis((6.0 * share) as u64)),
        }
    }

    /// Asks for what cannot be done.
    fn err(&mut self) {
        let (base, share) = (scene(), self.share());
        let mut settings = base.simulation.clone();
        settings.strands.constrain.iterations = 0;
        self.refuse(match (5.0 * share) as u32 {
            0 => Change::Length(2.5),
            1 => Change::Camera(Camera { field_of_view: f32::NAN, ..Camera::front() }),
            2 => Change::Wind(WindSection { gust: 7.0, ..WindSection::default() }),
            3 => Change::Picture(PictureSettings { width: 0, ..base.picture }),
            _ => Change::Settings(Box::new(settings)),
        });
    }

    fn save(&mut self, name: &str) {
        self.saves += 1;
        let path = self.folder.join(name);
        self.tell(Command::Save(Box::new(scene()), self.loaded, path));
    }

    /// Sets everything back but the hair, in mid-swing, and saves it: the picture of the saved scene is the
    /// one that is seen, though the head has not come to its place yet.
    fn keep(&mut self) {
        let base = scene();
        self.wait(|person| person.loaded >= person.load);
        self.tell(Command::Play(false));
        self.tell(Command::Adapt(false));
        for change in [
            Change::Release,
            Change::Settings(Box::new(base.simulation.clone())),
            Change::Length(1.0),
            Change::Wind(base.wind.clone()),
            Change::Look(Box::new(base.look.clone())),
            Change::BodyLook(base.body_look),
            Change::Lights(base.lights.clone()),
            Change::LevelOfDetail(base.level_of_detail),
            Change::Picture(base.picture),
            Change::Camera(Camera::front()),
            // One that it cannot be at.
            Change::Motion(Box::new(MotionSection { name: MotionName::Turn, ..base.motion.clone() })),
            Change::Motion(Box::new(base.motion.clone())),
        ] {
            self.tell(change);
        }
        self.wait(|person| person.last.drawn_after_command == person.sent);
        self.save("kept.toml");
        self.wait(|person| person.saved == person.saves);
        let saved = Scene::load(&self.folder.join("kept.toml")).unwrap();
        let mut player = strandline::Player::new(&saved, saved.devices, true).unwrap();
        let drawn = player.find_map(|event| match event.unwrap() {
            Event::Drawn { picture, .. } => Some(picture),
            _ => None,
        });
        assert_eq!(apart(&drawn.unwrap(), &self.last.picture), 0, "what was saved is what was seen");
    }

    /// The picture at rest and the one some steps later.
    fn begin_again(&mut self) -> [Picture; 2] {
        self.tell(Change::Reset);
        self.wait(|person| person.last.drawn_after_command == person.sent);
        let rest = self.last.picture.clone();
        // A step at a time: of several the picture of the first may be the last that has to be waited for.
        for _ in 0..20 {
            self.tell(Command::Step);
            self.wait(|person| person.last.drawn_after_command == person.sent);
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
fn thousands_of_pictures_with_changes_at_random() {
    let pictures = PICTURES[usize::from(!super::in_full())];
    let _alone = super::alone();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.hair"), b"PK nothing").unwrap();
    let mut person = Person::new(folder.path().to_owned());
    person.wait(|person| person.last.frame > 0);
    person.keep();
    let first = person.begin_again();
    assert!(apart(&first[0], &first[1]) > 20, "nothing moves: {}", apart(&first[0], &first[1]));
    person.tell(Command::Play(true));
    let mut checked = 0;
    while person.last.frame < pictures {
        match person.below(8) {
            0 | 1 => person.look_around(),
            2 | 3 => person.meddle(),
            4 | 5 => person.pull(),
            6 => person.play(),
            _ => person.err(),
        }
        let (seen, wait) = (person.last.frame, u64::from(person.below(3)));
        // The window may be the slow one.
        std::thread::sleep(Duration::from_micros(100 * u64::from(person.below(8))));
        person.wait(|person| person.last.frame >= seen + wait);
        if person.last.frame / CHECK > checked {
            checked = person.last.frame / CHECK;
            person.keep();
            let now = person.begin_again();
            assert_eq!(apart(&now[0], &first[0]), 0, "at rest it is what it was");
            assert_eq!(apart(&now[1], &first[1]), 0, "it moves as it did the first time");
            // Refusals alone are reported, each once; a scene that goes away takes its last errors along.
            let untold = person.refused - person.errors;
            assert!(untold <= 3 * person.loads, "{untold} of {}, {} loads", person.refused, person.loads);
            person.tell(Command::Play(true));
        }
    }
    assert_eq!(checked, pictures / CHECK);
}
