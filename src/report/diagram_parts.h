/* Internals of a diagram, shared by diagram.c, diagram_axes.c and diagram_media.c. */
#pragma once

#include "report/diagram.h"
#include "report/svg.h"

static inline double diagram_x(const diagram *d, double u)
{
    return d->frame.left + (u - d->plane.u0) * d->scale;
}

static inline double diagram_y(const diagram *d, double v)
{
    return d->frame.top + (d->plane.v1 - v) * d->scale;
}

void diagram_axes(const diagram *d, const char *caption);

/* The areas of the media, filled, and the boundaries between them. */
status diagram_media(diagram *d, diagnostic *why);
