//! What a reader of the sheet must know of its figures: causes, and what was tried.

/// Heading and body of the sections that go with the sheet.
pub const NOTES: &[(&str, &str)] = &[
    (
        "How pressure is read",
        "Pressure comes from the momentum that the multipliers of the last substep carry (Irving & Kirkwood 1950), not \
     from single multipliers. Particles i and j push each other with F_ij = -(lambda_i + lambda_j) V g x_ij/dt^2, where \
     grad W = g x; a wall pushes with F_w = -lambda_i G_w/dt^2 at the distance s_w. The stress of a particle is \
     V sigma = 1/2 sum F_ij x_ij + sum F_w s_w, its pressure half the trace; within the kernel of a wall only the part \
     across the wall is complete, and it alone is taken. On the lattice at rest this is lambda V mu/(m dt^2) with \
     mu = -sum y dW/dy: V mu = 0.9923 at h = 3 dx. That formula, applied to single multipliers, read 4 to 34 % high in a \
     tank 16 dx wide and 2.3 % low between periodic sides: a wall has no multiplier and carries no gradient along itself, \
     so the multipliers beside it must be larger to hold the same weight, and disorder (a mean V mu of 0.94) lowers the \
     gradient that a multiplier brings about.\n\n\
     The slope is fitted over all particles. Single particles in the three rows next to a floor or a surface read up \
     to 10 % off to both sides, as their layers do not share the stress evenly; sums over layers, and the forces on \
     walls, do not suffer from that.",
    ),
    (
        "Why vortices decay too fast",
        "Taylor-Green at Re 100 loses energy to numerical viscosity. Measured as the excess of the viscosity that is fitted \
     at t = 1 over the true 0.01, at 50 particles along the side and two substeps per frame of 1/100 s unless said: \
     0.0198 from a perfect lattice, 0.0023 with a jitter of 0.1 dx, 0.0018 with 0.2, 0.0014 with 0.5: a lattice resists \
     shear until it is broken up, so the case starts disordered. From there it is the arrangement that resists: \
     without any viscosity the excess is 0.0011, about the same; it grows with the stiffness of the constraint (0.0010 / 0.0014 at \
     one / two substeps at h = 3 dx, 0.0025 / 0.0026 at omega = 0.1 / 0.33 with the lattice-like start) and falls with the \
     width of the kernel (at 100 along the side 0.0012 / 0.0008 / 0.0006 at h = 3 / 3.5 / 4 dx). Gradients at the start, \
     the default here, are best (0.0006; half way 0.0009, predicted 0.0011); a one-sided constraint is worse (0.0017). \
     Softer settings let the flow compress: at h = 4 dx and 200 along the side, three substeps leave 0.0004 at t = 1 but \
     7.7 % of error on the way, from waves of 2 % in density; four, which `auto` takes, 0.0005 and 8.2 %. The band of 6 % \
     is not met by any setting tried; the best is h = 4 dx.",
    ),
    (
        "Where a level settles",
        "A column 10 dx deep stands 0.2 dx too low at h = 3 dx, 2.0 % where 1.2 % is the band; deeper ones hold it. The row \
     at the floor gives way: it should lie at 0.5 dx and lies at 0.2 dx (0.1 dx at a depth of 30), as a wall pushes with \
     the multiplier of the particle alone where two particles push with the sum of both. The wider the kernel, the \
     more: +0.4 / -1.2 / -2.0 / -3.0 % at h = 2 / 2.5 / 3 / 4 dx, so h = 2.5 dx holds the band. Forces on walls do not \
     suffer, as clamping carries the rest. Letting walls push with twice the multiplier was tried: it follows from no \
     constraint and heats (10 to 16 dx/s in a tank at rest).",
    ),
];
