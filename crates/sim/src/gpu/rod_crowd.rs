//! Rods that push each other: kernels of a part of a step, as cpu/rod_crowd.rs.

use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, kernel};

use super::inputs::Step;
use super::rod_buffers::RodBuffers;
use super::rod_crowd_buffers::{ContactState, CrowdBuffers, pairs_of};
use super::stage::Target;

kernel! {
    /// The beginning of a step; one thread is one strand.
    pub(super) struct LoadRoom in "begin_room" (super::linked::BEGIN_ROOM), entry "load_room" {
        0 step: Read Step,
        2 rods: Read f32,
        4 positions: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
    }
}

kernel! {
    /// The beginning of a part; one thread is one strand.
    pub(super) struct BeginRoom in "begin_room" (super::linked::BEGIN_ROOM), entry "begin_room" {
        0 step: Read Step,
        1 air: Read f32,
        2 rods: Read f32,
        3 rest: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
    }
}

kernel! {
    /// Points where the part begins; one thread is one point.
    pub(super) struct LayPoints in "sort_ways" (super::linked::SORT_WAYS), entry "lay_points" {
        0 step: Read Step,
        3 rest: Read f32,
        5 predicted: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
        12 points_ahead: ReadWrite [f32; 4],
        15 bucket_ends: ReadWrite u32,
        17 radii: Read f32,
    }
}

kernel! {
    /// The size of the boxes; one thread is one segment.
    pub(super) struct MeasureBoxes in "sort_ways" (super::linked::SORT_WAYS), entry "measure_boxes" {
        0 step: Read Step,
        12 points_ahead: ReadWrite [f32; 4],
        14 cells_taken: ReadWrite u32,
    }
}

kernel! {
    /// The histogram; one thread is one segment.
    pub(super) struct CountBoxes in "sort_ways" (super::linked::SORT_WAYS), entry "count_boxes" {
        0 step: Read Step,
        12 points_ahead: ReadWrite [f32; 4],
        14 cells_taken: ReadWrite u32,
        15 bucket_ends: ReadWrite u32,
    }
}

kernel! {
    /// The sort; one thread is one segment.
    pub(super) struct ListBoxes in "sort_ways" (super::linked::SORT_WAYS), entry "list_boxes" {
        0 step: Read Step,
        12 points_ahead: ReadWrite [f32; 4],
        14 cells_taken: ReadWrite u32,
        15 bucket_ends: ReadWrite u32,
        16 order: ReadWrite u32,
    }
}

kernel! {
    /// Segments that may touch; one thread is one segment.
    pub(super) struct FindPartners in "find_partners" (super::linked::FIND_PARTNERS), entry "find_partners" {
        0 step: Read Step,
        12 points_ahead: ReadWrite [f32; 4],
        13 kept: ReadWrite [f32; 4],
        14 cells_taken: ReadWrite u32,
        15 bucket_ends: ReadWrite u32,
        16 order: ReadWrite u32,
        18 partners: ReadWrite u32,
    }
}

kernel! {
    /// The pairs; one thread is one segment.
    pub(super) struct MeetPairs in "meet_pairs" (super::linked::MEET_PAIRS), entry "meet_pairs" {
        0 step: Read Step,
        8 pairs: ReadWrite [f32; 4],
        9 forces: ReadWrite [f32; 4],
        12 points_ahead: ReadWrite [f32; 4],
        13 kept: ReadWrite [f32; 4],
        14 cells_taken: ReadWrite u32,
        18 partners: ReadWrite u32,
        19 contacts: ReadWrite ContactState,
    }
}

kernel! {
    /// A round of the pairs; one thread is one segment.
    pub(super) struct AnswerPairs in "answer_pairs" (super::linked::ANSWER_PAIRS), entry "answer_pairs" {
        0 step: Read Step,
        8 pairs: ReadWrite [f32; 4],
        9 forces: ReadWrite [f32; 4],
        10 ways: ReadWrite [f32; 4],
    }
}

kernel! {
    /// A Newton step; one thread is one strand.
    pub(super) struct PushRoom in "push_room" (super::linked::PUSH_ROOM), entry "push_room" {
        0 step: Read Step,
        2 rods: Read f32,
        3 rest: Read f32,
        6 velocities: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
        8 pairs: ReadWrite [f32; 4],
        9 forces: ReadWrite [f32; 4],
        10 ways: ReadWrite [f32; 4],
    }
}

kernel! {
    /// A round of the strands; one thread is one strand.
    pub(super) struct RoundRoom in "round_room" (super::linked::ROUND_ROOM), entry "round_room" {
        0 step: Read Step,
        2 rods: Read f32,
        7 work: ReadWrite [f32; 4],
        8 pairs: ReadWrite [f32; 4],
        9 forces: ReadWrite [f32; 4],
        10 ways: ReadWrite [f32; 4],
    }
}

kernel! {
    /// The end of a part; one thread is one strand.
    pub(super) struct EndRoom in "end_room" (super::linked::END_ROOM), entry "end_room" {
        0 step: Read Step,
        2 rods: Read f32,
        3 rest: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
        8 pairs: ReadWrite [f32; 4],
        9 forces: ReadWrite [f32; 4],
    }
}

kernel! {
    /// Memory of the pairs; one thread is one segment.
    pub(super) struct KeepPairs in "meet_pairs" (super::linked::MEET_PAIRS), entry "keep_pairs" {
        0 step: Read Step,
        5 predicted: ReadWrite f32,
        8 pairs: ReadWrite [f32; 4],
        9 forces: ReadWrite [f32; 4],
        12 points_ahead: ReadWrite [f32; 4],
        13 kept: ReadWrite [f32; 4],
        19 contacts: ReadWrite ContactState,
    }
}

kernel! {
    /// The end of a step; one thread is one strand.
    pub(super) struct FinishRoom in "end_room" (super::linked::END_ROOM), entry "finish_room" {
        0 step: Read Step,
        2 rods: Read f32,
        5 predicted: ReadWrite f32,
        6 velocities: ReadWrite f32,
        7 work: ReadWrite [f32; 4],
    }
}

/// The pipeline constant CROWD (rod_room.wesl), by its number: strands push each other.
const CROWD: (&str, f64) = ("3", 1.0);
/// The number of the pipeline constant PAIRS (rod_pairs.wesl).
const PAIRS: &str = "4";

/// The kernels.
pub(super) struct Crowd {
    load: Kernel<LoadRoom<'static>>,
    begin: Kernel<BeginRoom<'static>>,
    lay_points: Kernel<LayPoints<'static>>,
    measure_boxes: Kernel<MeasureBoxes<'static>>,
    count_boxes: Kernel<CountBoxes<'static>>,
    list_boxes: Kernel<ListBoxes<'static>>,
    find_partners: Kernel<FindPartners<'static>>,
    meet_pairs: Kernel<MeetPairs<'static>>,
    answer_pairs: Kernel<AnswerPairs<'static>>,
    push: Kernel<PushRoom<'static>>,
    round: Kernel<RoundRoom<'static>>,
    end: Kernel<EndRoom<'static>>,
    keep_pairs: Kernel<KeepPairs<'static>>,
    finish: Kernel<FinishRoom<'static>>,
}

impl Crowd {
    pub fn declarations() -> [Declaration; 14] {
        [
            LoadRoom::declaration(),
            BeginRoom::declaration(),
            LayPoints::declaration(),
            MeasureBoxes::declaration(),
            CountBoxes::declaration(),
            ListBoxes::declaration(),
            FindPartners::declaration(),
            MeetPairs::declaration(),
            AnswerPairs::declaration(),
            PushRoom::declaration(),
            RoundRoom::declaration(),
            EndRoom::declaration(),
            KeepPairs::declaration(),
            FinishRoom::declaration(),
        ]
    }

    /// Compiles the kernels for a number of segments; `skins` is the constant of the solids.
    pub fn new(gpu: &Gpu, skins: (&str, f64), segments: usize) -> Result<Self, GpuError> {
        let pairs = (PAIRS, pairs_of(segments) as f64);
        Ok(Self {
            load: Kernel::new(gpu, &[])?,
            begin: Kernel::new(gpu, &[skins])?,
            lay_points: Kernel::new(gpu, &[])?,
            measure_boxes: Kernel::new(gpu, &[])?,
            count_boxes: Kernel::new(gpu, &[])?,
            list_boxes: Kernel::new(gpu, &[])?,
            find_partners: Kernel::new(gpu, &[pairs])?,
            meet_pairs: Kernel::new(gpu, &[pairs])?,
            answer_pairs: Kernel::new(gpu, &[pairs])?,
            push: Kernel::new(gpu, &[CROWD, pairs])?,
            round: Kernel::new(gpu, &[pairs])?,
            end: Kernel::new(gpu, &[skins, pairs])?,
            keep_pairs: Kernel::new(gpu, &[pairs])?,
            finish: Kernel::new(gpu, &[])?,
        })
    }

    /// The kernels of a step: in each part a search for pairs, then Newton steps, each followed by rounds.
    pub fn bind(&self, to: &Target, of: &RodBuffers, crowd: &CrowdBuffers) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let (step, rest, strands, segments) =
            (&buffers.step, &buffers.rest, buffers.lane_count, buffers.point_count());
        let (positions, predicted) = (&buffers.places[side], &buffers.places[1 - side]);
        let (velocities, contacts) = (&buffers.velocities, &buffers.contacts);
        let RodBuffers { nodes: rods, work, .. } = of;
        let air = of.shelter.as_ref().map_or(&of.no_air, |shelter| &shelter.air);
        let CrowdBuffers { pairs, forces, kept, ways, points_ahead, .. } = crowd;
        let load = LoadRoom { step, rods, positions, predicted, velocities, work };
        let begin = BeginRoom { step, air, rods, rest, predicted, velocities, work };
        let answer = AnswerPairs { step, pairs, forces, ways };
        let push = PushRoom { step, rods, rest, velocities, work, pairs, forces, ways };
        let round = RoundRoom { step, rods, work, pairs, forces, ways };
        let end = EndRoom { step, rods, rest, predicted, velocities, work, pairs, forces };
        let keep = KeepPairs { step, predicted, pairs, forces, points_ahead, kept, contacts };
        let answer = self.answer_pairs.bind(gpu, &answer)?.over(segments);
        let push = self.push.bind(gpu, &push)?.over(strands);
        let round = self.round.bind(gpu, &round)?.over(strands);
        let mut part = vec![self.begin.bind(gpu, &begin)?.over(strands)];
        part.extend(self.search(to, of, crowd)?);
        for newton in 0..crowd.rounds.newton_steps {
            part.extend((newton > 0).then(|| answer.clone()));
            part.push(push.clone());
            for _ in 0..crowd.rounds.rounds {
                part.extend([answer.clone(), round.clone()]);
            }
        }
        part.push(self.end.bind(gpu, &end)?.over(strands));
        part.push(self.keep_pairs.bind(gpu, &keep)?.over(segments));
        let finish = FinishRoom { step, rods, predicted, velocities, work };
        let mut dispatches = vec![self.load.bind(gpu, &load)?.over(strands)];
        (0..crowd.rounds.parts).for_each(|_| dispatches.extend_from_slice(&part));
        dispatches.push(self.finish.bind(gpu, &finish)?.over(strands));
        Ok(dispatches)
    }

    /// The kernels that find the pairs of a part.
    fn search(&self, to: &Target, of: &RodBuffers, crowd: &CrowdBuffers) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, scan, .. } = *to;
        let (step, rest, contacts) = (&buffers.step, &buffers.rest, &buffers.contacts);
        let (predicted, work, segments) = (&buffers.places[1 - side], &of.work, buffers.point_count());
        let CrowdBuffers { pairs, forces, kept, partners, points_ahead, radii, .. } = crowd;
        let CrowdBuffers { cells_taken, bucket_ends, totals, order, .. } = crowd;
        let lay = LayPoints { step, rest, predicted, work, points_ahead, bucket_ends, radii };
        let measure = MeasureBoxes { step, points_ahead, cells_taken };
        let count = CountBoxes { step, points_ahead, cells_taken, bucket_ends };
        let list = ListBoxes { step, points_ahead, cells_taken, bucket_ends, order };
        let find = FindPartners { step, points_ahead, kept, cells_taken, bucket_ends, order, partners };
        let meet = MeetPairs { step, pairs, forces, points_ahead, kept, cells_taken, partners, contacts };
        let mut dispatches = vec![
            self.lay_points.bind(gpu, &lay)?.over(segments),
            self.measure_boxes.bind(gpu, &measure)?.over(segments),
            self.count_boxes.bind(gpu, &count)?.over(segments),
        ];
        dispatches.extend(scan.bind(gpu, bucket_ends, totals)?);
        dispatches.push(self.list_boxes.bind(gpu, &list)?.over(segments));
        dispatches.push(self.find_partners.bind(gpu, &find)?.over(segments));
        dispatches.push(self.meet_pairs.bind(gpu, &meet)?.over(segments));
        Ok(dispatches)
    }
}
