//#import pathtrace/integrator/photon/map.wgsl
// The photons of a pass, sorted into a map in four steps: how many each bucket has, where it begins, which they are, and
// in which order. The first three leave that to chance; the last one puts each bucket's photons into the order in which
// the processor has them, so that sums are the same from run to run. Where a bucket lies changes no sum. Twin:
// crates/pathtrace/src/integrator/photon/map.rs, which counts and sums in one thread.

struct PhotonList {
    found: u32,
    cut_photons: u32,
    rays: u32,
    rays_high: u32,
    photons: array<Photon>,
}

@group(0) @binding(0) var<uniform> asked: PhotonParams;
@group(0) @binding(1) var<storage, read> list: PhotonList;
@group(0) @binding(2) var<storage, read_write> map: PhotonMap;
// of each bucket how many photons it has, then where the next of them goes; behind all of them how many have a place
@group(0) @binding(3) var<storage, read_write> buckets: array<atomic<u32>>;
// bucket after bucket the order and the number in the list of each photon
@group(0) @binding(4) var<storage, read_write> entries: array<vec2u>;

fn bucket_of_photon(index: u32) -> u32 {
    return bucket_of(map.grid, cell_of(map.grid, list.photons[index].position));
}

@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3u) {
    let index = asked.first + id.x;
    if index < asked.end {
        atomicAdd(&buckets[bucket_of_photon(index)], 1u);
    }
}

// Gives places to two buckets, which share a word.
@compute @workgroup_size(64)
fn allot(@builtin(global_invocation_id) id: vec3u) {
    let pair = asked.first + id.x;
    if pair < asked.end {
        map.words[pair] = vec4u(places_of(2u * pair), places_of(2u * pair + 1u));
    }
}

// Where the photons of a bucket begin and end.
fn places_of(bucket: u32) -> vec2u {
    let photons = atomicLoad(&buckets[bucket]);
    if photons == 0u {
        return vec2u(0u);
    }
    let first = atomicAdd(&buckets[map.grid.mask + 1u], photons);
    atomicStore(&buckets[bucket], first);
    return vec2u(first, first + photons);
}

@compute @workgroup_size(64)
fn collect(@builtin(global_invocation_id) id: vec3u) {
    let index = asked.first + id.x;
    if index < asked.end {
        let place = atomicAdd(&buckets[bucket_of_photon(index)], 1u);
        entries[place] = vec2u(list.photons[index].order, index);
    }
}

// Puts a photon behind all of its bucket that come earlier.
@compute @workgroup_size(64)
fn order(@builtin(global_invocation_id) id: vec3u) {
    let place = asked.first + id.x;
    if place >= asked.end {
        return;
    }
    let entry = entries[place];
    let bucket = bucket_of_photon(entry.y);
    let pair = map.words[bucket / 2u];
    let places = select(pair.xy, pair.zw, (bucket & 1u) == 1u);
    var sorted = places.x;
    for (var other = places.x; other < places.y; other++) {
        sorted += select(0u, 1u, entries[other].x < entry.x);
    }
    let photon = list.photons[entry.y];
    let word = map.grid.photons + 2u * sorted;
    map.words[word] = vec4u(bitcast<vec3u>(photon.position), photon.normal);
    map.words[word + 1u] = vec4u(bitcast<vec3u>(photon.power), photon.order);
}
