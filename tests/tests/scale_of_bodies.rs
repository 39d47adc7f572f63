//! Bodies, ropes and soft bodies are the same at any scale.

use crate::scale::{HEAD, TANK, same_at_any_scale};

#[test]
fn a_heap_of_bodies_is_the_same_at_any_scale() {
    for contacts in ["", "method = \"split_jacobi\""] {
        let text = format!(
            r#"{HEAD}
            [contacts]
            {contacts}
            [[body]]
            name = "box"
            size = [<0.1 m>, <0.1 m>]
            position = [<0.3 m>, <0.05 m>]
            density = <1000 kg/m2>
            copies = {{ columns = 3, rows = 3, step = [<0.11 m>, <0.1 m>] }}
            [[body]]
            name = "ball"
            radius = <0.06 m>
            position = [<0.33 m>, <0.8 m>]
            velocity = [<0.2 m/s>, <-2.0 m/s>]
            restitution = 0.6
            density = <3000 kg/m2>
            linear_damping = <0.1 1/s>
            [[body]]
            name = "stuck"
            radius = <0.06 m>
            position = [<0.85 m>, <0.03 m>]
            density = <1000 kg/m2>
            [[body]]
            name = "arm"
            size = [<0.2 m>, <0.04 m>]
            position = [<0.8 m>, <0.6 m>]
            density = <1000 kg/m2>
            [[joint]]
            kind = "hinge"
            body = "arm"
            at = [<0.72 m>, <0.6 m>]
            motor_speed_deg = <90 1/s>
            motor_torque = <2 Nm>
            [[joint]]
            kind = "rod"
            body = "ball"
            other = "arm"
            at = [<0.33 m>, <0.8 m>]
            other_at = [<0.88 m>, <0.6 m>]
            compliance = <0.001 m/N>
            damping = <3 Ns/m>
            {TANK}"#
        );
        same_at_any_scale("heap", 90, &text);
    }
}

#[test]
fn bodies_in_water_are_the_same_at_any_scale() {
    for solver in ["pressure_grid = \"off\"", "pressure_grid = \"on\""] {
        let text = format!(
            r#"{HEAD}
            [solver]
            {solver}
            [[liquid]]
            name = "water"
            density = <1000 kg/m2>
            [[block]]
            material = "water"
            min = [0.0, 0.0]
            max = [<1.0 m>, <0.4 m>]
            [[body]]
            name = "float"
            size = [<0.2 m>, <0.15 m>]
            position = [<0.3 m>, <0.5 m>]
            density = <500 kg/m2>
            [[body]]
            name = "stone"
            radius = <0.08 m>
            position = [<0.7 m>, <0.7 m>]
            density = <2500 kg/m2>
            [[body]]
            name = "paddle"
            kind = "kinematic"
            size = [<0.1 m>, <0.3 m>]
            position = [<0.5 m>, <0.2 m>]
            motion = {{ amplitude = [<0.1 m>, 0.0], frequency = <1 1/s> }}
            [[body]]
            name = "ramp"
            kind = "static"
            outline = [[0.0, 0.0], [<0.3 m>, 0.0], [<0.3 m>, <0.15 m>]]
            position = [<0.7 m>, 0.0]
            {TANK}"#
        );
        same_at_any_scale("bodies in water", 40, &text);
    }
}

#[test]
fn ropes_and_soft_bodies_are_the_same_at_any_scale() {
    let text = format!(
        r#"{HEAD}
        [[liquid]]
        name = "water"
        density = <1000 kg/m2>
        [[solid]]
        name = "cord"
        density = <200 kg/m2>
        [[block]]
        material = "water"
        min = [0.0, 0.0]
        max = [<1.0 m>, <0.2 m>]
        [[rope]]
        material = "cord"
        from = [<0.1 m>, <0.8 m>]
        to = [<0.9 m>, <0.8 m>]
        held = "both"
        compliance = <1e-7 m/N>
        [[body]]
        name = "soft"
        solver = "shape_matching"
        compliance = <1e-6 m/N>
        damping = 0.0
        density = <500 kg/m2>
        size = [<0.25 m>, <0.2 m>]
        position = [<0.5 m>, <0.5 m>]
        angle_deg = 20.0
        {TANK}"#
    );
    same_at_any_scale("soft things", 40, &text);
}
