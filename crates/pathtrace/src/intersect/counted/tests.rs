use super::*;

/// A grid of triangles, bent so that rays meet it at all angles and behind each other.
fn sheet(side: u32) -> Arc<Mesh> {
    let at = |x: u32, z: u32| {
        let [x, z] = [x, z].map(|step| step as f32 / side as f32);
        Vec3::new(x, (5.0 * x).fract() * 0.3 + z * z * 0.2, z)
    };
    let positions = (0..=side).flat_map(|z| (0..=side).map(move |x| at(x, z))).collect();
    let corner = |x: u32, z: u32| z * (side + 1) + x;
    let cells = (0..side).flat_map(|z| (0..side).map(move |x| (x, z)));
    let triangles = cells.flat_map(|(x, z)| {
        let [a, b, c, d] = [corner(x, z), corner(x + 1, z), corner(x + 1, z + 1), corner(x, z + 1)];
        [[a, b, c], [a, c, d]]
    });
    Arc::new(Mesh::new(positions, triangles.collect()))
}

fn rays() -> impl Iterator<Item = Ray> {
    (0..400u32).map(|i| {
        let [u, v] = [i * 7 % 20, i * 13 % 19].map(|step| step as f32 / 20.0 + 0.013);
        let direction = Vec3::new(v - 0.5, -1.0, u - 0.4).normalize();
        Ray { origin: Vec3::new(u, 2.0, v), direction, tmax: f32::INFINITY }
    })
}

#[test]
fn every_structure_finds_the_same_triangles() {
    let mesh = sheet(64);
    let made = Structure::ALL.map(|structure| CountedMesh::new(&mesh, structure, &|_| true).unwrap());
    let mut met = 0;
    for ray in rays() {
        let hits = made.each_ref().map(|made| made.closest(&ray, &mut Tests::default()).map(|hit| hit.t));
        assert_eq!(hits[0], hits[1], "{ray:?}");
        assert_eq!(hits[0], hits[2], "{ray:?}");
        assert_eq!(hits, made.each_ref().map(|made| made.distance(&ray)), "{ray:?}");
        met += usize::from(hits[0].is_some());
    }
    assert!(met > 150, "{met}");
}

#[test]
fn a_list_costs_all_triangles_and_a_tree_their_logarithm() {
    let cost = |structure, side| {
        let mesh = sheet(side);
        let made = CountedMesh::new(&mesh, structure, &|_| true).unwrap();
        let mut tests = Tests::default();
        rays().for_each(|ray| _ = made.closest(&ray, &mut tests));
        (tests.boxes as f64 / 400.0, tests.triangles as f64 / 400.0)
    };
    assert_eq!(cost(Structure::List, 16), (0.0, 512.0));
    for structure in [Structure::Two, Structure::Eight] {
        let [small, large] = [16, 128].map(|side| cost(structure, side));
        // sixty-four times as many triangles: less than twice the boxes, hardly more triangles
        assert!(large.0 < 2.5 * small.0 && large.1 < 2.0 * small.1 + 4.0, "{structure:?}: {small:?}, {large:?}");
        assert!(large.1 < 40.0, "{structure:?}: {large:?}");
    }
}

#[test]
fn boxes_of_a_depth_hold_all_corners() {
    let mesh = sheet(32);
    for structure in [Structure::Two, Structure::Eight] {
        let made = CountedMesh::new(&mesh, structure, &|_| true).unwrap();
        assert!(made.depth() > 2, "{structure:?}");
        for depth in 0..=made.depth() {
            let (reached, boxes) = made.boxes_at(depth, 1 << 30);
            assert_eq!(reached, depth);
            let held = |p: &Vec3| boxes.iter().any(|(lo, hi)| p.cmpge(*lo).all() && p.cmple(*hi).all());
            assert!(mesh.positions().iter().all(held), "{structure:?} at {depth}");
        }
        assert_eq!(made.boxes_at(0, 9).1.len(), 1);
        // a level that is drawn is whole
        let (depth, boxes) = made.boxes_at(9, 70);
        assert!(depth < 9 && boxes.len() <= 70 && boxes == made.boxes_at(depth, 1 << 30).1);
    }
}

#[test]
fn what_is_cancelled_is_not_made() {
    assert!(Structure::ALL.iter().all(|&structure| CountedMesh::new(&sheet(8), structure, &|_| false).is_none()));
}
