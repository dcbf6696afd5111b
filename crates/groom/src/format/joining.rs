//! Joins lines that share end points into strands, in whatever order and direction a file lists them.

use strandline_base::counted;

/// Lines between vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// First point of each line, and behind them the number of points.
    pub starts: Vec<u32>,
    /// Vertex of each point.
    pub points: Vec<u32>,
}

/// Lines that were joined.
#[derive(Clone, Debug, PartialEq)]
pub struct Joined {
    pub lines: Lines,
    /// The first of the lines in each strand.
    pub firsts: Vec<u32>,
    /// Vertices at which more than two lines meet: strands end there.
    pub branchings: usize,
    /// Strands that are closed rings, cut open at the line that the file lists first.
    pub rings: usize,
}

impl Joined {
    /// Notes on what is odd, human-readable.
    pub fn problems(&self, listed: usize) -> Vec<String> {
        let mut problems = Vec::new();
        let strands = self.firsts.len();
        if strands < listed {
            let strands = counted(strands, "strand", "strands");
            problems.push(format!("{listed} lines that share their ends are joined into {strands}"));
        }
        if self.branchings > 0 {
            let points = counted(self.branchings, "point", "points");
            problems.push(format!("{points} where strands branch: strands end there"));
        }
        if self.rings > 0 {
            problems.push(counted(self.rings, "strand is a ring, cut open", "strands are rings, cut open"));
        }
        problems
    }
}

impl Lines {
    fn line(&self, line: usize) -> &[u32] {
        &self.points[self.starts[line] as usize..self.starts[line + 1] as usize]
    }

    fn count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Joins lines at vertices where exactly two of them end.
    ///
    /// A line of more than two points runs from root to tip: two such lines that begin at one vertex share a root and
    /// stay apart. A strand runs as most of its lines do; of an even number, from the end that is listed first.
    /// Vertices are below `vertices`.
    pub fn joined(self, vertices: usize) -> Joined {
        let mut junctions = Junctions::new(&self, vertices);
        if !junctions.any {
            let firsts = (0..self.count() as u32).collect();
            return Joined { lines: self, firsts, branchings: 0, rings: 0 };
        }
        let mut joined = Joined {
            lines: Lines { starts: vec![0], points: Vec::with_capacity(self.points.len()) },
            firsts: Vec::new(),
            branchings: junctions.branchings(),
            rings: 0,
        };
        let mut chain = Vec::new();
        for line in 0..self.count() {
            if junctions.is_taken[line] {
                continue;
            }
            let is_ring = self.chain(line, &mut junctions, &mut chain);
            joined.rings += usize::from(is_ring);
            self.append(&chain, &mut joined);
        }
        joined
    }

    /// The lines of the chain that holds one, from one end to the other; tells rings.
    fn chain(&self, line: usize, junctions: &mut Junctions, chain: &mut Vec<End>) -> bool {
        // An end names the line that is left through it.
        let start = End { line, is_last: true };
        let mut first = start;
        let mut is_ring = false;
        while let Some(before) = junctions.other(self, first.opposite()) {
            if before.line == line {
                is_ring = true;
                first = start;
                break;
            }
            first = before;
        }
        chain.clear();
        let mut next = Some(first);
        while let Some(end) = next.filter(|end| !junctions.is_taken[end.line]) {
            junctions.is_taken[end.line] = true;
            chain.push(end);
            next = junctions.other(self, end).map(End::opposite);
        }
        is_ring
    }

    /// Appends a chain as one strand.
    fn append(&self, chain: &[End], joined: &mut Joined) {
        let along = chain.iter().filter(|end| end.is_last).count();
        let listed = |end: Option<&End>| end.map_or(0, |end| end.line);
        let is_turned = match (2 * along).cmp(&chain.len()) {
            std::cmp::Ordering::Less => true,
            std::cmp::Ordering::Equal => listed(chain.last()) < listed(chain.first()),
            std::cmp::Ordering::Greater => false,
        };
        let begin = joined.lines.points.len();
        let mut put = |end: End| {
            let own = self.line(end.line);
            let points = &mut joined.lines.points;
            // The first point is the last one of the line before.
            let skipped = usize::from(points.len() > begin);
            if end.is_last {
                points.extend(own.iter().skip(skipped));
            } else {
                points.extend(own.iter().rev().skip(skipped));
            }
        };
        if is_turned {
            chain.iter().rev().map(|end| end.opposite()).for_each(&mut put);
        } else {
            chain.iter().copied().for_each(&mut put);
        }
        joined.lines.starts.push(joined.lines.points.len() as u32);
        joined.firsts.push(chain.iter().map(|end| end.line as u32).min().unwrap_or_default());
    }
}

/// One of the two ends of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct End {
    line: usize,
    is_last: bool,
}

impl End {
    fn opposite(self) -> Self {
        Self { is_last: !self.is_last, ..self }
    }
}

/// Added to the count of ends where a vertex is within a line.
const INNER: u8 = 16;

/// The ends of lines that meet at each vertex.
struct Junctions {
    /// Number of ends, 4 at most, and [`INNER`] more at a point within a line.
    counts: Vec<u8>,
    /// Two ends of a vertex: twice the line, and one more for its last point.
    ends: Vec<[u32; 2]>,
    /// Lines that belong to a strand already, or repeat another one.
    is_taken: Vec<bool>,
    any: bool,
}

impl Junctions {
    fn new(lines: &Lines, vertices: usize) -> Self {
        let mut junctions = Self {
            counts: vec![0; vertices],
            ends: Vec::new(),
            is_taken: vec![false; lines.count()],
            any: false,
        };
        for line in 0..lines.count() {
            let (Some(first), Some(last)) = (lines.line(line).first(), lines.line(line).last()) else {
                continue;
            };
            for vertex in [*first, *last] {
                let count = &mut junctions.counts[vertex as usize];
                *count = (*count + 1).min(4);
                junctions.any |= *count > 1 && first != last;
            }
        }
        if junctions.any {
            junctions.meet(lines, vertices);
        }
        junctions
    }

    /// Finds which ends meet, repeated segments left out.
    fn meet(&mut self, lines: &Lines, vertices: usize) {
        let mut segments: Vec<([u32; 2], u32)> = (0..lines.count())
            .filter_map(|line| match *lines.line(line) {
                [one, two] => Some(([one.min(two), one.max(two)], line as u32)),
                _ => None,
            })
            .collect();
        segments.sort_unstable();
        for pair in segments.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            self.is_taken[pair[1].1 as usize] = true;
        }
        self.counts.fill(0);
        self.ends = vec![[0; 2]; vertices];
        for line in (0..lines.count()).filter(|line| !self.is_taken[*line]) {
            let own = lines.line(line);
            let [Some(first), Some(last)] = [own.first(), own.last()] else { continue };
            for inner in own.get(1..own.len() - 1).unwrap_or_default() {
                self.counts[*inner as usize] |= INNER;
            }
            for (vertex, is_last) in [(*first, 0), (*last, 1)] {
                let count = &mut self.counts[vertex as usize];
                let ends = *count % INNER;
                if let Some(slot) = self.ends[vertex as usize].get_mut(usize::from(ends)) {
                    *slot = 2 * line as u32 + is_last;
                }
                *count += u8::from(ends < 4);
            }
        }
    }

    fn branchings(&self) -> usize {
        let is_branching = |count: u8| count % INNER > 2 || count > INNER;
        self.counts.iter().filter(|count| is_branching(**count)).count()
    }

    /// The end of another line that is joined to an end.
    fn other(&self, lines: &Lines, end: End) -> Option<End> {
        let own = lines.line(end.line);
        let vertex = *(if end.is_last { own.last() } else { own.first() })? as usize;
        if self.counts[vertex] != 2 {
            return None;
        }
        let ends = self.ends[vertex].map(|end| End { line: (end / 2) as usize, is_last: end % 2 == 1 });
        let other = if ends[0] == end { ends[1] } else { ends[0] };
        let is_segment = |end: End| lines.line(end.line).len() == 2;
        let is_joined = end.is_last != other.is_last || is_segment(end) || is_segment(other);
        (other.line != end.line && is_joined).then_some(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(lines: &[&[u32]]) -> (Vec<Vec<u32>>, Joined) {
        let mut all = Lines { starts: vec![0], points: Vec::new() };
        for line in lines {
            all.points.extend(*line);
            all.starts.push(all.points.len() as u32);
        }
        let joined = all.joined(20);
        let strands = (0..joined.lines.count()).map(|line| joined.lines.line(line).to_vec()).collect();
        (strands, joined)
    }

    #[test]
    fn segments_become_strands_in_any_order_and_direction() {
        let expected = vec![vec![0, 1, 2, 3], vec![7, 8, 9]];
        assert_eq!(joined(&[&[0, 1], &[1, 2], &[2, 3], &[7, 8], &[8, 9]]).0, expected);
        assert_eq!(joined(&[&[2, 3], &[0, 1], &[7, 8], &[8, 9], &[1, 2]]).0, expected);
        // One segment of three is turned: the others say which end is the root.
        assert_eq!(joined(&[&[0, 1], &[2, 1], &[2, 3], &[7, 8], &[8, 9]]).0, expected);
        // All from tip to root, as the file has them.
        assert_eq!(joined(&[&[3, 2], &[2, 1], &[1, 0]]).0, [[3, 2, 1, 0]]);
        // As many one way as the other: the first that is listed begins.
        assert_eq!(joined(&[&[0, 1], &[2, 1]]).0, [[0, 1, 2]]);
        assert_eq!(joined(&[&[1, 0], &[1, 2]]).0, [[0, 1, 2]]);
        // Pieces of several points join head to tail; a segment that is listed twice counts once.
        assert_eq!(joined(&[&[3, 4, 5], &[0, 1, 3]]).0, [[0, 1, 3, 4, 5]]);
        assert_eq!(joined(&[&[0, 1], &[1, 2], &[2, 1]]).0, [[0, 1, 2]]);
    }

    #[test]
    fn whole_strands_stay_as_they_are() {
        let strands: [&[u32]; 3] = [&[0, 1, 2], &[3, 4, 5], &[0, 6, 7]];
        let (found, joined) = joined(&strands);
        assert_eq!(found, strands, "a root that two strands share joins nothing");
        assert_eq!((joined.branchings, joined.rings), (0, 0));
        assert!(joined.problems(3).is_empty());
    }

    #[test]
    fn branchings_and_rings_are_told() {
        let (strands, branched) = joined(&[&[0, 1], &[1, 2], &[2, 3], &[2, 4], &[4, 5]]);
        assert_eq!(strands, [vec![0, 1, 2], vec![2, 3], vec![2, 4, 5]]);
        assert_eq!(branched.problems(5).len(), 2);
        assert_eq!(branched.branchings, 1);
        assert_eq!(joined(&[&[0, 1, 2], &[1, 3], &[3, 4]]).1.branchings, 1, "at a point within a line");
        let (strands, ring) = joined(&[&[0, 1], &[1, 2], &[2, 0], &[8, 9]]);
        assert_eq!(strands, [vec![0, 1, 2, 0], vec![8, 9]]);
        assert_eq!(ring.rings, 1);
        assert_eq!(joined(&[&[5, 5], &[1, 2], &[2, 3]]).0, [vec![5, 5], vec![1, 2, 3]]);
    }
}
