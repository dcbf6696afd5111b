// Exclusive prefix sums in place: within blocks, over the totals of the blocks, and both together.

@group(0) @binding(0) var<storage, read_write> values: array<u32>;
@group(0) @binding(1) var<storage, read_write> totals: array<u32>;

// Numbers of a block: 64 threads with 16 each.
const BLOCK = 1024u;
const RUN = 16u;

var<workgroup> sums: array<u32, 256>;

// Sum of what the threads before this one hold; `width` threads take part.
fn sum_before(thread: u32, own: u32, width: u32) -> u32 {
    sums[thread] = own;
    workgroupBarrier();
    for (var reach = 1u; reach < width; reach *= 2u) {
        var before = 0u;
        if thread >= reach {
            before = sums[thread - reach];
        }
        workgroupBarrier();
        sums[thread] += before;
        workgroupBarrier();
    }
    return sums[thread] - own;
}

// One block is one workgroup.
@compute @workgroup_size(64)
fn scan_blocks(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let block = group.x + group.y * groups.x;
    let first = block * BLOCK + thread * RUN;
    let end = min(first + RUN, arrayLength(&values));
    var own = 0u;
    for (var index = first; index < end; index++) {
        own += values[index];
    }
    var sum = sum_before(thread, own, 64u);
    if thread == 63u && block < arrayLength(&totals) {
        totals[block] = sum + own;
    }
    for (var index = first; index < end; index++) {
        let value = values[index];
        values[index] = sum;
        sum += value;
    }
}

// All blocks are one workgroup.
@compute @workgroup_size(256)
fn scan_totals(@builtin(local_invocation_index) thread: u32) {
    let count = arrayLength(&totals);
    let run = (count + 255u) / 256u;
    let first = thread * run;
    let end = min(first + run, count);
    var own = 0u;
    for (var index = first; index < end; index++) {
        own += totals[index];
    }
    var sum = sum_before(thread, own, 256u);
    for (var index = first; index < end; index++) {
        let value = totals[index];
        totals[index] = sum;
        sum += value;
    }
}

// One number is one thread.
@compute @workgroup_size(64)
fn scan_add(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = (group.x + group.y * groups.x) * 64u + thread;
    if index < arrayLength(&values) {
        values[index] += totals[index / BLOCK];
    }
}
