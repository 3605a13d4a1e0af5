/* Where a ray's segment is in the image, for drawings over it. Pure. */
#pragma once

#include "scene/model/camera.h"

/* The part of a segment in front of the camera: x and y in pixels from the image's upper left corner, z the distance
 * from the eye, or from the plane of an orthographic camera. False if nothing of it is in front, or if it is so far
 * outside that it does not cross the image. */
bool segment_place(const camera_frame *view, int width, int height, vec3 from, vec3 to, vec3 ends[2]);
