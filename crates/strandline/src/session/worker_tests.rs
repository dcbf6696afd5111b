//! The two workers on real threads, either side slow at random.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use strandline_base::Random;

use crate::session::worker::{Gone, Work, Worker};

/// Writes its settings and the number of its frame all over a page.
struct Writer {
    setting: u64,
    frame: u64,
    ended: Arc<Mutex<bool>>,
}

struct Order {
    page: Vec<[u64; 2]>,
    setting: Option<u64>,
    wait: Duration,
    panic: bool,
}

impl Work for Writer {
    type Job = Order;
    type Done = Vec<[u64; 2]>;

    fn run(&mut self, order: Order) -> Vec<[u64; 2]> {
        assert!(!order.panic, "as asked");
        self.setting = order.setting.unwrap_or(self.setting);
        let mut page = order.page;
        page.resize(64, [0; 2]);
        for (index, line) in page.iter_mut().enumerate() {
            if index == 32 {
                std::thread::sleep(order.wait);
            }
            *line = [self.frame, self.setting];
        }
        self.frame += 1;
        page
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        *self.ended.lock().unwrap() = true;
    }
}

fn writer() -> (Writer, Arc<Mutex<bool>>) {
    let ended = Arc::new(Mutex::new(false));
    (Writer { setting: 0, frame: 0, ended: ended.clone() }, ended)
}

fn order(page: Vec<[u64; 2]>) -> Order {
    Order { page, setting: None, wait: Duration::ZERO, panic: false }
}

/// A whole number that repeats with its seed, so that a failure does.
fn random(state: &mut Random) -> u64 {
    state.bits().into()
}

/// Plays frames with two pages that change hands, either side slow at random, and settings that
/// change at random; checks that no frame is torn, lost, repeated or out of order, and that a setting
/// shows from the first frame that was started after it.
fn play(frames: u64, slow: impl Fn(u64) -> [u64; 2], seed: u64) {
    let (work, ended) = writer();
    let mut worker = Worker::new(work).unwrap();
    let (mut state, mut setting) = (Random::new(seed, 0), 0);
    let mut settings = std::collections::VecDeque::new();
    let mut spare = vec![Vec::new(), Vec::new()];
    let mut start = |worker: &mut Worker<Writer>, page, state: &mut Random| {
        let number = random(state);
        let change = number.is_multiple_of(5).then_some(number);
        setting = change.unwrap_or(setting);
        settings.push_back(setting);
        let wait = Duration::from_micros(slow(random(state))[0]);
        worker.start(Order { setting: change, wait, ..order(page) }).unwrap();
        settings.clone()
    };
    let mut expected = start(&mut worker, spare.pop().unwrap(), &mut state);
    for frame in 0..frames {
        let page = worker.finish().unwrap();
        if frame + 1 < frames {
            expected = start(&mut worker, spare.pop().unwrap(), &mut state);
            assert_eq!(worker.started(), 1);
        }
        // Drawing reads the page while the next one is written.
        std::thread::sleep(Duration::from_micros(slow(random(&mut state))[1]));
        assert!(page.iter().all(|line| *line == [frame, expected[frame as usize]]), "frame {frame}");
        if random(&mut state).is_multiple_of(50) {
            assert!(worker.work().frame > frame);
        }
        spare.push(page);
    }
    assert_eq!(worker.started(), 0);
    drop(worker);
    assert!(*ended.lock().unwrap(), "the thread has ended");
}

#[test]
fn ten_thousand_frames_come_whole_and_in_order_whichever_side_is_slow() {
    play(4000, |_| [0, 0], 1);
    play(2000, |number| [number % 60, 0], 2);
    play(2000, |number| [0, number % 60], 3);
    play(2000, |number| [number % 7 * 20, number % 11 * 15], 4);
}

#[test]
fn ending_in_the_middle_waits_for_the_job_and_no_longer() {
    for wait in [0, 2000] {
        let (work, ended) = writer();
        let mut worker = Worker::new(work).unwrap();
        let wait = Duration::from_micros(wait);
        worker.start(Order { wait, ..order(Vec::new()) }).unwrap();
        worker.start(order(Vec::new())).unwrap();
        drop(worker);
        assert!(*ended.lock().unwrap());
    }
}

#[test]
fn a_panic_is_reported_and_the_last_state_stays() {
    let (work, _) = writer();
    let mut worker = Worker::new(work).unwrap();
    worker.start(order(Vec::new())).unwrap();
    worker.start(Order { panic: true, ..order(Vec::new()) }).unwrap();
    assert_eq!(worker.finish().unwrap()[0], [0, 0]);
    assert_eq!(worker.finish(), Err(Gone));
    assert_eq!(worker.work().frame, 1);
    // The thread may still be on its way out: at last it takes nothing.
    while worker.start(order(Vec::new())).is_ok() {
        std::thread::yield_now();
    }
}
