//! Notes on the figures of the sheet: causes, and attempted remedies.

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
        "Why vortices decay as they should",
        "A position-based liquid loses the energy of vortices because its arrangement resists shear: it is strained, \
     gives way, and the pushes that rearrange it enter the velocities. Before shifting, Taylor-Green at Re 100 ended \
     18.6 / 17.0 / 12.8 % below the exact energy at 50 / 100 / 200 particles along the side (target 1 %), and more \
     substeps made it worse. At 100 along the side \
     that is an excess viscosity of 0.0012 over the true 0.01, and 0.0005 where there is none and the vortices keep their \
     speed. Less than 1e-4 of the energy stands in disordered motion: the mode itself is braked. The viscous operator is \
     not at fault: on these arrangements it gives 0.988 to 0.991 of nu.\n\n\
     What helps, each alone at 100 along the side (error of the energy at t = 1; shifting 0.05): pair repulsion below \
     0.8 dx moves positions but not velocities 4.4 %, no repulsion 14.5 %, shifting beside repulsion 4.2 %, shifting in \
     its place 1.5 %, shifting beside repulsion that velocities do not follow 1.3 %. Shifting is the displacement that one \
     pressure everywhere would bring about, added to positions and kept out of velocities, as in the \
     transport-velocity formulation (Adami, Hu & Adams 2013). It needs no pass of its own, as the sums of the constraint \
     already hold the gradient, and takes the place of the repulsion pass in liquids that fill their domain. It keeps \
     momentum to round-off.\n\n\
     What does not: the mean taken out of the multipliers 17.0 %, a positive pressure that velocities do follow 20.9 % (a \
     negative one blows up), corrections smoothed once before they enter velocities 18.5 % and twice 18.7 %, gradients of \
     differences in the velocities 19.5 % (and a drift of momentum of 1e-3), half of each correction kept out of \
     velocities 17.3 %; smoothed multipliers 13.6 %. With shifting of 0.03 beside hidden repulsion, gradients half way and at the \
     predicted positions give 3.0 and 4.8 %, a start from the lattice 1.9 %.\n\n\
     As it stands, 4.5 / 1.9 / 0.9 % are left at 50 / 100 / 200 along the side, at 200 3.1 % at target 4 % and \
     1.5 % at target 0.25 %. Shifting goes with the way that the fastest particle makes in a substep, whole from 0.15 dx on, and \
     beside a wall only along it: across a channel 16 dx wide, rows that are shifted at every substep alike brake \
     Poiseuille flow (3.9 % instead of 1.6 %). With both, it is 1.6 % at target 1 % and 2.9 % at 0.25 % (1.9 % without \
     shifting); from 17 dx on there is no harm (1.0 %). Shifting by the speed of each particle alone leaves vortex \
     centres as they are: 1.33 instead of 1.15 of the true viscosity at Re 1000 and 200 along the side.\n\n\
     Shifting has a limit: a mode with the relaxation s is stable under shifting b for s < (4 - 2b)/(3 - b), and beyond \
     it energy grows. At h = 3 dx and omega = 0.33 the limit is between 0.05 and 0.07 (0.07 is stable at omega = 0.3), at \
     4 dx and omega = 0.22 between 0.01 and 0.02: there omega is 0.19 now. Gas is not shifted: its loss comes from the \
     repulsion, which it needs where streams meet. Kept out of velocities there, the repulsion lowers the effective \
     viscosity of gas in a box from 7.5 to 1.5 dx^2/s, but a jet into the void gains speed without bound.",
    ),
    (
        "Where a level settles",
        "Two particles push each other with the sum of both multipliers, a wall has none to add. With the plain integral \
     of the kernel behind a wall the lowest row therefore gave way: it lay at 0.1 to 0.2 dx from the floor instead of \
     0.5 dx, and columns 10 and 30 dx deep stood 2.2 and 1.2 % too low at target 1 %, two layers of 8 dx read 2.2 % of \
     pressure too little. Now the distance at which a wall is seen is stretched about half a spacing (`Coverage::upholding`): \
     the part behind the wall is the same there, its gradient 1.25 times as large, the true ones return at the kernel radius. \
     What pushes is still the gradient of one potential, so nothing heats: noise fell (0.60 to 0.46 dx/s at 10 dx).\n\n\
     What was tried before that came out: twice the multiplier at walls heats (10 to 16 dx/s), as it follows from no \
     potential. A wavy distance, d - A sin(2 pi d/dx) dx/2 pi, that doubles the gradient at all rows (A = 1) holds the \
     level too (-1.0 %), but layers the liquid along walls: a standing wave loses 0.28 per period instead of 0.16, heavy \
     over light overturns at 0.78 instead of 0.94 of the rate. A shift of all walls by 0.05 dx holds the level (-0.7 %) \
     and costs the profile of a Couette flow (1.9 instead of 0.7 %). Steeper by 0.4 instead of 0.25 the wave loses 0.17, by 1 \
     0.23. The midpoint sum of a lattice behind the wall instead of the integral is lower by 1.6 and 0.9 % at the first \
     two rows for h = 3 dx: liquids would stand lower still. Heavy over light now overturns at 0.91 instead of 0.94 of the \
     exact rate at 48 dx.\n\n\
     Gas, and liquids without a surface, keep the plain integral: they have no level, and with the steeper one the fronts \
     of a lock exchange ran at 0.90 instead of 0.92 and more of theory.\n\n\
     What is left of the level at target 1 % (-0.9 % at 10 dx, -0.5 % deeper) is compression, and goes with the target. \
     Bands of level, pressure and draft are meant for targets of 1 % and less; at 4 % these figures are reported only.",
    ),
    (
        "Why the constraint is taken early",
        "The correction of a substep turns into velocity, and the later in the substep the constraint is taken, the more it \
     brakes: at x_n + eta dt v each mode loses eta times what it loses at the predicted positions, and one iteration per \
     substep is linearly stable below omega lambda_max = 4/(1 + 2 eta). With eta = 0.3, omega at h = 3 dx may be 0.57; \
     half way it is 0.48, at the prediction 0.36. So the same target takes 8 % fewer substeps than half way and 21 % fewer \
     than at the prediction, and the worst C of a dam break of 3,200 at target 1 % falls from 3.3 to 1.8 %. That is \
     what liquids with a surface do, where there is nothing but liquid: beside bodies the damping is worth its cost. \
     Gradients at the start damp a wave as little (single \
     runs scatter by 0.01 per period; means of nine at target 1 %: early 0.112 and 0.127, half way 0.123; at the start, n = 4, \
     0.119), but take a pass of their own and the smallest omega.\n\n\
     The price is less damping of small motion: a column 30 dx deep ends with 0.66 dx/s instead of 0.51 half way, one of \
     10 dx with 0.72 instead of 0.68. At eta = 0 the surface boils (3 dx/s), so 0.3 it is. A substep counts for this with no \
     more way than the Courant condition gives, 0.4 dx: a particle that ten times that speed carried into a wall was never \
     that far back along its velocity, and nine of 2,000 random scenes lost one through a wall.\n\n\
     Why not h = 2 dx, which is cheaper by half? Its own density error is as small as it is told to be, but where \
     particles lie in disorder the narrow kernel takes them for denser than they are, and the liquid swells: a column \
     30 dx deep stands 0.9 to 1.0 % too high at 16 and 32 substeps, where that of h = 3 dx is 0.1 to 0.2 % off, and the \
     interior of a dam break is off by 0.4 % (0.1 % at h = 3 dx), which more substeps do not mend. By compression \
     alone it would win that case; hence |C|.",
    ),
    (
        "The pressure grid",
        "A grid of cells two spacings wide carries the smooth pressure (`solver.pressure_grid`); the particles correct \
     what is left, and the number of substeps follows from the speed. Conjugate gradients end at a hundredth of the first \
     residual, at less where densities differ, by the root of their ratio. Rigid bodies are part of the operator (Batty et \
     al. 2007), so light and heavy ones are equally stable. Two settings decide about energy. Velocities follow three \
     tenths of the corrections of the particles: all of it takes 2 to 6 % of the energy of a drop drawn out, none of it \
     gives a dam break 0.7 %. Moves take 0.06 of the density error per frame, however many substeps it has: per substep, as \
     before, waves lost the more, the more substeps there were. Faces closed by walls must be felt like the next ones away \
     from them, else the lowest row falls. Cells within the liquid that are filled less than 0.98 are drawn together: the \
     grid would keep their pores open. Not so at bodies of less than a fiftieth of the density: the gap below a box of a \
     hundredth, 24 dx wide, closed again and again, pumped it, at 0.06 of sqrt(g b), for 0.009 now. \
     Cells that a light float covers nearly, and that no fluid reaches through an open face, are no liquid: as such \
     they pushed boxes of a thousandth aside, at 0.02 to 0.22 of sqrt(g b), for less than 0.003 now. \
     Cells that lie within a wall but for a corner hold no particle, and are as deep as the cell they open into: as air \
     they let a full ring fall into them, a disc in it was let go 8 % too slowly at 12 dx, and water at rest around \
     sunk discs moved at 0.5 to 5 dx/s, for 0.05 to 0.1 now. Liquids with a surface must be two cells deep before them: \
     the ends of films run out too fast.\n\n\
     Its pressures are those of the grid, and of the three tenths of the multipliers that change velocities, added up: with \
     the whole multipliers a jet read 13 to 19 % too much where it hits a plate, and a wall that a broken dam hits 39 %, \
     for 1 and -4 % now. Read from the momentum of pairs, as without a grid, pressures come out 5 to 11 % low, since the \
     grid pushes smoothly whatever the arrangement. The target \
     compression bounds the way of a substep alone (0.8 dx at 1 %, as its root; 0.5 dx for fluids that fill their domain). \
     The fuzzer gives the grid to every second scene that it supports. A wave of 32 dx has an amplitude of a quarter of a \
     cell: what is said of its decay is the noise of that.",
    ),
    (
        "Where energy grows",
        "A block that touches walls starts up to 1.6 % too dense beside them (the integral behind a wall against the sum \
     over a lattice). Left as it was it threw the liquid up: more, the shorter the substeps, as the same correction is a \
     larger velocity: 0.8 to 4 % of energy at 32 and 64 substeps in tanks 8 dx wide. Starts are settled before \
     time 0 by projections without gravity; a part of each displacement now goes on while it is pushed the same way, \
     so that a hundred of them settle 30 layers, where it was their square. A tank 8 dx wide and 100 deep still gained \
     0.8 % at 32 substeps after a hundred projections (0.5 % after 200, 0.4 % after 300, nothing after 1000). The excess is \
     that of two rows out of the width: a start no wider than 16 dx now takes three projections per layer, a wider one \
     as many fewer, and at least a hundred.\n\n\
     Without the pressure grid the compression of the particles is what carries a liquid. A pool that started at its \
     rest density first fell for the time that sound takes through it: of its weight, its floor felt 0.24 to 0.97 \
     over the first 0.05 s and up to 1.9 later (pools 40 spacings deep, 4 to 16 substeps), and its particles moved at \
     3 to 11 spacings per second. Pools, layers and tanks with bodies that rest are now lowered by their strain and \
     then run in substeps of the first frame with damped velocities, without the settling above: after some 50 to 120 \
     of them, up to 400 around a body and 200 in a pool 150 deep, the force is within 3 % of the weight. (The same \
     compression by the momentum method of settling is that of a noisier arrangement: it swung by 15 %.) A pool rests \
     if it does not move, nothing below its level is open, and its liquids lie in layers; what does not rest starts \
     as it did (`cargo test -p unipbd-tests --test shows starts:: -- --nocapture`).\n\n\
     Stiffness goes with 1/dt^2: where the number of substeps rose, the same compression pushed harder at once, and \
     what was stored came out with interest. Elliptical drops at targets of 2 to 8 % gained 1.7 % (100 dx, from three to four \
     substeps) to 4.4 % (30 dx, from one to two). Now a stiffness that need not rise for the target grows by 2 % per frame, and \
     the number counts the speed that pressure may still bring about, so that it rises less late: of 35 radii from 18 to \
     150 dx at four targets none gains more than 0.4 %. Scenes with two-sided fluids are left as they were.",
    ),
];
