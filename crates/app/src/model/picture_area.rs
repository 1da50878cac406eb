//! Where pictures are shown, and what a camera sees there.

use scene::Camera;

/// Where pictures are shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureArea {
    /// Width and height of one picture in physical pixels.
    pub size: (u32, u32),
    /// Left, top, right and bottom of the whole area in points.
    pub corners: [f32; 4],
    /// Pixels of the area along a side of one of the picture.
    pub shrink: u32,
    /// By how much more than the camera's own field of view a picture shows, along its height.
    widening: f32,
}

impl Default for PictureArea {
    fn default() -> Self {
        PictureArea { size: (0, 0), corners: [0.0; 4], shrink: 1, widening: 1.0 }
    }
}

impl PictureArea {
    /// An area of `whole` physical pixels, of which one picture takes `part`, with a pixel for `shrink` by `shrink` of
    /// them.
    pub fn new(whole: [f32; 2], part: [f32; 2], shrink: u32, corners: [f32; 4]) -> Self {
        let side = |pixels: f32| (pixels.round().max(1.0) as u32).div_ceil(shrink);
        let aspect = |[width, height]: [f32; 2]| width.max(1.0) / height.max(1.0);
        let widening = (aspect(whole).max(1.0) / aspect(part)).max(1.0);
        PictureArea { size: (side(part[0]), side(part[1])), corners, shrink, widening }
    }

    /// An area for pictures of this size, whatever it is itself: that of one that another program made from the camera's
    /// own field of view.
    pub fn of_size(size: (u32, u32), corners: [f32; 4]) -> Self {
        PictureArea { size, corners, ..PictureArea::default() }
    }

    /// Width over height of the whole area.
    pub fn aspect(&self) -> f32 {
        let [left, top, right, bottom] = self.corners;
        (right - left).max(1.0) / (bottom - top).max(1.0)
    }

    /// The camera of one picture. In half of the area it shows at both sides all that it would show in the whole one, and
    /// more above and below instead of bars: a view that changes crops nothing. Nor does an area that becomes higher than
    /// wide: from a square on the field of view is that of the narrower side, as it is in pbrt.
    pub fn camera(&self, camera: &Camera) -> Camera {
        if self.widening > 1.0 { camera.zoomed(1.0 / self.widening) } else { *camera }
    }

    /// The camera that one picture shows by `shown`.
    pub fn own(&self, shown: &Camera) -> Camera {
        if self.widening > 1.0 { shown.zoomed(self.widening) } else { *shown }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tangents of half the angles that are seen along width and height.
    fn seen(whole: [f32; 2], part: [f32; 2]) -> [f32; 2] {
        let camera = scene::builtin::named("whitted").unwrap().camera;
        let area = PictureArea::new(whole, part, 1, [0.0; 4]);
        let frame = area.camera(&camera).frame(part[0] / part[1]);
        [frame.right.length(), frame.up.length()]
    }

    #[test]
    fn half_of_the_area_shows_all_that_the_whole_shows_at_the_sides_and_more_above_and_below() {
        let (whole, half) = (seen([980.0, 696.0], [980.0, 696.0]), seen([980.0, 696.0], [486.0, 696.0]));
        assert!((half[0] / whole[0] - 1.0).abs() < 1e-5 && half[1] > 1.9 * whole[1], "{half:?} {whole:?}");
        // a wide area: the halves are wide too, and are as high as the whole
        let (wide, half) = (seen([2000.0, 500.0], [2000.0, 500.0]), seen([2000.0, 500.0], [996.0, 500.0]));
        assert!((half[0] / wide[0] - 1.0).abs() < 1e-5, "{half:?} {wide:?}");
    }

    #[test]
    fn a_picture_that_is_wider_than_high_has_the_cameras_own_field_of_view_to_the_last_bit() {
        let camera = scene::builtin::named("whitted").unwrap().camera;
        for size in [[1280.0, 696.0], [980.0, 696.0], [696.0, 696.0]] {
            assert_eq!(PictureArea::new(size, size, 4, [0.0; 4]).camera(&camera), camera);
        }
    }

    #[test]
    fn an_area_that_becomes_narrow_does_not_crop_a_square() {
        let (square, narrow) = (seen([600.0, 600.0], [600.0, 600.0]), seen([300.0, 600.0], [300.0, 600.0]));
        assert!((narrow[0] / square[0] - 1.0).abs() < 1e-5 && narrow[1] > 1.9 * square[1], "{narrow:?} {square:?}");
    }

    #[test]
    fn the_camera_of_a_picture_is_told_from_what_it_shows() {
        let camera = scene::builtin::named("whitted").unwrap().camera;
        let area = PictureArea::new([980.0, 696.0], [486.0, 696.0], 1, [0.0; 4]);
        let shown = area.camera(&camera);
        assert!(shown.fov_y > 1.3 * camera.fov_y);
        let own = area.own(&shown);
        assert!((own.fov_y - camera.fov_y).abs() < 1e-4 && own.eye == camera.eye, "{own:?}");
    }

    #[test]
    fn a_pixel_for_several_does_not_change_what_is_seen() {
        let of = |shrink| PictureArea::new([981.0, 697.0], [487.0, 697.0], shrink, [0.0; 4]);
        let camera = scene::builtin::named("whitted").unwrap().camera;
        assert_eq!((of(4).size, of(1).size), ((122, 175), (487, 697)));
        assert_eq!(of(4).camera(&camera), of(1).camera(&camera));
    }
}
