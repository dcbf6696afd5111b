//! Steps of a scene that can be undone.

use std::sync::Arc;

use super::difference;
use crate::Scene;

/// Steps that are kept.
const MOST: usize = 2000;
/// Keys of a step above which it is another scene.
const MANY: usize = 24;

/// A step that can be undone.
#[derive(Clone)]
pub struct Step {
    /// Name of the change: the key and its value, human-readable.
    pub name: String,
    before: Arc<Scene>,
    after: Arc<Scene>,
}

/// The scene of a person, and the steps that led to it.
pub struct History {
    steps: Vec<Step>,
    /// Steps that are done; those after them are undone.
    done: usize,
    now: Arc<Scene>,
}

impl History {
    /// The history of a scene, without steps.
    pub fn new(scene: &Scene) -> Self {
        Self { steps: Vec::new(), done: 0, now: Arc::new(scene.clone()) }
    }

    /// Records the scene as it is now as a step, where it is another; undone steps are then forgotten. The size of the
    /// pictures is no part of it. Returns true where there is a new step.
    pub fn record(&mut self, scene: &Scene) -> bool {
        let mut scene = scene.clone();
        (scene.picture.width, scene.picture.height) = (self.now.picture.width, self.now.picture.height);
        if scene == *self.now {
            return false;
        }
        let name = name(&self.now, &scene);
        self.steps.truncate(self.done);
        let (before, after) = (self.now.clone(), Arc::new(scene));
        self.now = after.clone();
        self.steps.push(Step { name, before, after });
        if self.steps.len() > MOST {
            self.steps.remove(0);
        }
        self.done = self.steps.len();
        true
    }

    /// Takes the scene as it is now for the one of the last step: what a load chose is no step of its own.
    pub fn settle(&mut self, scene: &Scene) {
        self.now = Arc::new(scene.clone());
        if let Some(step) = self.done.checked_sub(1).and_then(|last| self.steps.get_mut(last)) {
            step.after = self.now.clone();
        }
        if let Some(next) = self.steps.get_mut(self.done) {
            next.before = self.now.clone();
        }
    }

    /// Goes back by a step: the scene before it; `None` at the beginning.
    pub fn undo(&mut self) -> Option<&Scene> {
        self.done.checked_sub(1).and_then(|done| self.go_to(done))
    }

    /// Does an undone step again: the scene after it; `None` where none is undone.
    pub fn redo(&mut self) -> Option<&Scene> {
        self.go_to(self.done + 1)
    }

    /// Goes to where so many steps are done; `None` where there are fewer.
    pub fn go_to(&mut self, done: usize) -> Option<&Scene> {
        self.now = match done.checked_sub(1) {
            Some(last) => self.steps.get(last)?.after.clone(),
            None => self.steps.first()?.before.clone(),
        };
        self.done = done;
        Some(&self.now)
    }

    /// The scene before the last step that changed a part of it; `None` where no step did.
    pub fn before(&self, differs: impl Fn(&Scene, &Scene) -> bool) -> Option<&Scene> {
        let done = self.steps[..self.done].iter().rev();
        done.map(|step| (&step.before, &step.after))
            .find(|(before, after)| differs(before, after))
            .map(|found| &**found.0)
    }

    /// All steps, the first first.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Number of the steps that are done; those after them are undone.
    pub fn done(&self) -> usize {
        self.done
    }
}

fn name(before: &Scene, after: &Scene) -> String {
    if let Some(stroke) = after.strokes.get(before.strokes.len()) {
        return stroke.tool.name().to_owned();
    }
    let found = difference(before, after);
    match &found[..] {
        [] => "a value".to_owned(),
        [(key, value)] => format!("{key} {value}").trim_end().to_owned(),
        _ if found.len() > MANY => "another scene".to_owned(),
        [(key, value), rest @ ..] => format!("{key} {value}, and {} more", rest.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strandline_base::Random;

    /// A random change of a scene, of one of many kinds.
    fn change(scene: &mut Scene, random: &mut Random) {
        let bits = random.bits();
        let number = (bits >> 8) as f32 / 16_777_216.0;
        match bits % 10 {
            0 => scene.look.width_scale = 0.1 + number,
            1 => scene.look.root_color.x = number,
            2 => scene.wind.velocity.y = 4.0 * number - 2.0,
            3 => scene.motion.rotation.y = 20.0 * number,
            4 => scene.simulation.damping = number,
            5 => scene.lights.push(crate::Light { intensity: number, ..crate::Light::default() }),
            6 => {
                scene.lights.pop();
            }
            7 => scene.groom.length = 0.2 + number,
            8 => scene.groom.file = Some(format!("{bits}.hair").into()),
            _ => scene.picture.exposure = number,
        }
    }

    #[test]
    fn a_thousand_random_steps_are_undone_and_done_again_to_the_bit() {
        let start = Scene::demo();
        let (mut history, mut scene, mut random) = (History::new(&start), start.clone(), Random::new(3, 9));
        let mut texts = vec![start.to_toml()];
        for step in 0..1000 {
            let before = scene.clone();
            change(&mut scene, &mut random);
            assert_eq!(history.record(&scene), scene != before, "step {step}");
            if scene != before {
                texts.push(scene.to_toml());
            }
            // Now and then back and on again.
            if random.bits() % 7 == 0 && history.done() > 2 {
                history.undo();
                scene = history.undo().unwrap().clone();
                texts.truncate(texts.len() - 2);
                assert_eq!(scene.to_toml(), *texts.last().unwrap());
            }
        }
        let steps = history.steps().len();
        assert!(steps >= 300 && texts.len() == history.done() + 1, "{steps}");
        let kept = &texts;
        for at in (0..history.done()).rev() {
            assert_eq!(history.undo().unwrap().to_toml(), kept[at], "back to {at}");
        }
        assert!(history.undo().is_none());
        assert_eq!(kept[0], start.to_toml(), "the beginning");
        for text in &kept[1..] {
            assert_eq!(history.redo().unwrap().to_toml(), *text);
        }
        assert!(history.redo().is_none());
        assert_eq!(history.done(), steps);
    }

    #[test]
    fn a_new_step_forgets_those_that_are_undone_and_steps_have_names() {
        let mut scene = Scene::demo();
        let mut history = History::new(&scene);
        assert!(history.undo().is_none() && history.redo().is_none());
        for width in [1.5, 2.0, 2.5] {
            scene.look.width_scale = width;
            assert!(history.record(&scene));
        }
        let looked = |one: &Scene, other: &Scene| one.look != other.look;
        assert_eq!(history.before(looked).map(|scene| scene.look.width_scale), Some(2.0));
        assert!(history.before(|one, other| one.wind != other.wind).is_none());
        assert!(!history.record(&scene), "nothing is no step");
        let sized = Scene { picture: crate::PictureSettings { width: 77, ..scene.picture }, ..scene.clone() };
        assert!(!history.record(&sized), "the size of a window is none either");
        assert_eq!(history.undo().map(|scene| scene.look.width_scale), Some(2.0));
        assert_eq!(history.undo().map(|scene| scene.look.width_scale), Some(1.5));
        let mut other = scene.clone();
        (other.look.width_scale, other.wind.gust) = (1.5, 0.25);
        assert!(history.record(&other));
        let names: Vec<&str> = history.steps().iter().map(|step| step.name.as_str()).collect();
        assert_eq!(names, ["look.width_scale 1.5", "wind.gust 0.25"]);
        assert_eq!(
            history.go_to(0).map(|scene| scene.look.width_scale),
            Some(Scene::demo().look.width_scale)
        );
        assert!(history.go_to(3).is_none());
    }

    #[test]
    fn what_a_load_chose_belongs_to_its_step() {
        let start = Scene::demo();
        let mut history = History::new(&start);
        let mut loaded = start.clone();
        loaded.groom.file = Some("a.hair".into());
        history.record(&loaded);
        let mut fitted = loaded.clone();
        fitted.look.follow_strands = 3;
        history.settle(&fitted);
        assert!(!history.record(&fitted));
        assert_eq!(history.undo().map(Scene::to_toml), Some(start.to_toml()));
        assert_eq!(history.redo().map(Scene::to_toml), Some(fitted.to_toml()));
    }
}
