/* The lines of rays in drawings: one rule for images (beams.h), pages (report/page.h), sections
 * (report/diagram.h) and the laboratory (`far_end` of the JSON of a ray). A ray that meets a surface or a light ends
 * there. A ray that leaves the scene has no end: its line runs to the edge of the frame, or to its vanishing point if
 * that is in the frame. A ray that was cut has no line, since its end is unknown. Pure; cannot fail. */
#pragma once

#include "render/inspect/probe.h"
#include "render/inspect/section.h"
#include "scene/model/camera.h"

/* The points from + s along for 0 <= s <= end; end is HUGE_VAL for a ray that leaves the scene. Scene units. */
typedef struct ray_line {
    vec3 from, along;
    double end;
} ray_line;

ray_line ray_line_of(const ray_node *node);
ray_line ray_line_between(vec3 from, vec3 to);

/* The end of the line in homogeneous coordinates x, y, z, w: a point with w = 1, or with w = 0 the direction of a ray
 * that leaves the scene. */
void ray_line_far_end(const ray_line *line, double xyzw[4]);

/* A rectangle in an image of width x height pixels; pixels from its upper left corner, left < right, top < bottom. */
typedef struct image_frame {
    int width, height;
    double left, top, right, bottom;
} image_frame;

/* The frame of the image itself, with a margin on each side. */
image_frame image_frame_of(int width, int height, double margin_px);

/* The part of a line that a camera sees in the frame: x and y in pixels, z the depth in front of the eye or of the
 * plane of an orthographic camera, HUGE_VAL at a vanishing point. A line that comes from behind begins where it enters
 * the frame, in front of the eye. A ray that leaves the scene past the plane of an orthographic camera goes on to the
 * edge of the frame, with a negative depth. Returns false if no part of it is in the frame. */
bool ray_line_seen(const ray_line *line, const camera_frame *view, const image_frame *frame, vec3 ends[2]);

/* The part of a line, projected orthogonally onto the plane, that is in its window. */
bool ray_line_projected(const ray_line *line, const section_plane *window, section_point ends[2]);
