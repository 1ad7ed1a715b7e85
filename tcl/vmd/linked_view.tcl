# linked_view.tcl: source, target and difference side by side in VMD's window; the mouse moves them together.

# VMD has one scene, in which each molecule has its own matrices: a point is centred, rotated and scaled, and finally
# translated by the global matrix. The mouse rotates all molecules, each about its own centre, so three panels that
# differ by the global matrix stay aligned. The source is first rotated into the target's frame.
namespace eval ::espdiff {
    # During a linked view: handle, panels (by source, target, difference: molecules), saved (the previous state),
    # rotation and centre (of the source, of the target), scale (VMD's own for the surface).
    variable linked {}

    # Centre of each panel, in units of half the window's width, and its title.
    variable panels {source {-0.6667 Source} target {0.0 Target} difference {0.6667 Difference}}
    variable panel_fill 0.72  ;# a surface that would fill VMD's window fills this fraction of a panel, to leave room
                               # for rotation

    # Replaces the handle's drawing and any other linked drawing.
    proc draw_linked {options handle} {
        variable linked
        if {[dict get [core::status $handle] kind] eq "surface"} {
            fail "-view linked: $handle is a surface, which is drawn alone; give a comparison"
        }
        set plans [panel_plans $options $handle]
        end_linked_view
        forget_drawing $handle
        if {![dict get $options keep]} { forget_other_drawings $handle }
        set saved [saved_scene]
        set made [dict create]
        set code [catch { keep_view { draw_panels $handle $plans made } } message error]
        if {$code} {
            keep_view { delete_molecules [concat {*}[dict values $made]] }
            return -options $error $message
        }
        set linked [dict merge [dict create handle $handle saved $saved panels [panel_members $handle $made]] \
            [panel_frames $handle [lindex [dict get $made target] 0]]]
        display projection Orthographic  ;# otherwise the outer panels would be seen from the side
        hide_others [concat {*}[dict values $made] {*}[dict values [dict get $linked panels]]]
        place_panels
        place_legends
        set molecules [concat {*}[dict values $made]]
        remember_drawing $handle $molecules $options
        add_frame_note $handle target
        return $molecules
    }

    # drawing_plan for each panel. Both potentials have the same range.
    proc panel_plans {options handle} {
        set field [dict get $options field]
        set quantity [drawn_quantity $handle [dict get $options color] 0 $field]
        set has_potentials [expr {![catch { core::range $handle [drawn_quantity $handle source 0 $field] }]}]
        set range [dict get $options potential-range]
        if {$has_potentials && $range eq "auto"} { set range [common_range $options $handle] }
        set plans [dict create]
        foreach {panel surface} {source source target mapped} {
            set own [dict create color [expr {$has_potentials ? $panel : "none"}] surface $surface range $range \
                uncertain plain legend 0]
            dict set plans $panel [drawing_plan [dict merge $options $own] $handle]
        }
        dict set plans difference [drawing_plan [dict merge $options {surface mapped}] $handle]
        return $plans
    }

    # The widest range of both sides and of the results that share the scale.
    proc common_range {options handle} {
        foreach side {source target} {
            set side [drawn_quantity $handle $side 0 [dict get $options field]]
            set found [drawn_range $handle $side [shared_range [dict replace $options range auto] $handle $side]]
            lappend lows [dict get $found low]
            lappend highs [dict get $found high]
        }
        return [list [tcl::mathfunc::min {*}$lows] [tcl::mathfunc::max {*}$highs]]
    }

    # Adds molecules to the caller's dict, by panel and by `fixed` (titles and legends).
    proc draw_panels {handle plans made_name} {
        upvar 1 $made_name made
        variable panels
        dict for {panel plan} $plans {
            set molecules {}
            draw_parts $handle $plan molecules
            dict set made $panel $molecules
        }
        set titles [dict create]
        dict for {panel place} $panels {
            set title [expr {$panel eq "difference" ? [lindex [split [dict get $plans difference color] :] end] : [lindex $place 1]}]
            dict set titles [lindex $place 0] [panel_title $handle $panel $title]
        }
        dict lappend made fixed [draw_panel_titles $handle $titles]
        set color [dict get $plans target color]
        dict set plans target title [expr {[string match *:* $color] ? [dict get [core::range $handle $color] label] : "Potential"}]
        if {[regexp {(^|:)difference$} [dict get $plans difference color]]} {
            dict set plans difference title "Target - source"
        }
        foreach {panel middle room} {target -0.3333 0.6 difference 0.6667 0.3} {
            set plan [dict get $plans $panel]
            if {[dict get $plan color] eq "none" || ![dict get $plans difference legend]} continue
            with_color_scale [dict get $plan colors] {
                dict lappend made fixed [set mol [draw_legend $plan $middle $room]]
                build_list $mol
            }
        }
    }

    # "Source: scTIM_chainA", or the quantity of the third panel.
    proc panel_title {handle panel title} {
        if {$panel eq "difference"} { return [string totitle [string map {_ " "} $title]] }
        foreach input [dict get [core::result $handle] inputs] {
            if {[dict get $input role] ne $panel} continue
            set name [dict get $input path]
            set frame ""
            regexp {^mol \d+ "(.*)" frame (\d+)} $name -> name frame
            append title ": [file rootname [file tail $name]]"
            if {$frame ni {"" 0}} { append title ", frame $frame" }
        }
        return $title
    }

    # The content of each panel: our surfaces, and the compared molecules. A molecule that is both source and target
    # shows the target.
    proc panel_members {handle made} {
        set members [dict create]
        foreach panel {source target difference} { dict set members $panel [dict get $made $panel] }
        set target [molecule_of $handle target]
        set source [molecule_of $handle source]
        if {$target ne ""} { dict lappend members target $target }
        if {$source ne "" && $source ne $target} { dict lappend members source $source }
        return $members
    }

    # The surface's centre on both sides, the rotation of the source into the target's frame, and VMD's scale for the
    # surface.
    proc panel_frames {handle surface} {
        variable matrices
        set view [saved_view]
        mol top $surface
        display resetview
        set centre [matrix_translation [lindex [molinfo $surface get center_matrix] 0]]
        set scale [lindex [molinfo $surface get scale_matrix] 0 0 0]
        restore_view $view
        set superposition [dict get [core::result $handle] superposition]
        set rotation [dict get $superposition rotation_row_major]
        set shift [dict get $superposition translation_A]
        # The target's centre is -centre; the corresponding point on the source is R^-1 (x - t).
        set on_source {}
        foreach column {0 1 2} {
            set sum 0
            foreach row {0 1 2} {
                set sum [expr {$sum + [lindex $rotation [expr {3 * $row + $column}]]
                    * (-[lindex $centre $row] - [lindex $shift $row])}]
            }
            lappend on_source [expr {-$sum}]
        }
        return [dict create rotation $rotation centre [dict create target $centre difference $centre \
            source $on_source] scale $scale]
    }

    proc matrix_translation {matrix} { list [lindex $matrix 0 3] [lindex $matrix 1 3] [lindex $matrix 2 3] }

    proc translation_matrix {vector} {
        lassign $vector x y z
        list [list 1 0 0 $x] [list 0 1 0 $y] [list 0 0 1 $z] {0 0 0 1}
    }

    proc rotation_product {matrix rotation} {
        set product {}
        foreach row {0 1 2} {
            set entries {}
            foreach column {0 1 2} {
                set sum 0
                foreach k {0 1 2} {
                    set sum [expr {$sum + [lindex $matrix $row $k] * [lindex $rotation [expr {3 * $k + $column}]]}]
                }
                lappend entries $sum
            }
            lappend product [concat $entries 0]
        }
        return [concat $product {{0 0 0 1}}]
    }

    # Moves each panel's molecules into place, all with the target's current rotation.
    proc place_panels {} {
        variable linked
        variable panels
        variable panel_fill
        if {$linked eq ""} return
        lassign [scene_unit] unit aspect
        set turned [lindex [molinfo [lindex [dict get $linked panels target] 0] get rotate_matrix] 0]
        # With VMD's own scale a molecule fills 1.5 of its units.
        set room [expr {$panel_fill * $unit * min(2 * $aspect / 3, 1.5)}]
        set scale [expr {[dict get $linked scale] * $room / 1.5}]
        dict for {panel members} [dict get $linked panels] {
            set rotation $turned
            if {$panel eq "source"} { set rotation [rotation_product $turned [dict get $linked rotation]] }
            set x [expr {[lindex [dict get $panels $panel] 0] * $aspect * $unit}]
            foreach mol $members {
                if {$mol ni [molinfo list]} continue
                molinfo $mol set center_matrix [list [translation_matrix [dict get $linked centre $panel]]]
                molinfo $mol set rotate_matrix [list $rotation]
                molinfo $mol set scale_matrix [list [list [list $scale 0 0 0] [list 0 $scale 0 0] \
                    [list 0 0 $scale 0] {0 0 0 1}]]
                molinfo $mol set global_matrix [list [translation_matrix [list $x [expr {0.03 * $unit}] 0]]]
            }
        }
    }

    # Half the window's height at the molecules' depth, in VMD's units, and the window's aspect ratio.
    proc scene_unit {} {
        list [expr {[display get height] / 4.0}] [lindex [legend_screen] 2]
    }

    # The state to restore at the end: matrices, displayed molecules, projection.
    proc saved_scene {} { dict create view [saved_view] projection [display get projection] }

    proc hide_others {members} {
        foreach mol [molinfo list] { if {$mol ni $members && [molinfo $mol get displayed]} { mol off $mol } }
        foreach mol $members { mol on $mol }
    }

    # Ends any linked view; the molecules keep their rotation.
    proc end_linked_view {} {
        variable linked
        if {$linked ne ""} { forget_drawing [dict get $linked handle] }
    }

    # Called before the drawing's molecules are deleted; returns the state for restore_scene, which is called
    # afterwards.
    proc leave_linked_view {handle} {
        variable linked
        if {$linked eq "" || [dict get $linked handle] ne $handle} { return {} }
        set saved [dict get $linked saved]
        set target [lindex [dict get $linked panels target] 0]
        if {$target in [molinfo list]} { dict set saved turned [molinfo $target get rotate_matrix] }
        set linked {}
        return $saved
    }

    proc restore_scene {saved} {
        if {$saved eq ""} return
        if {[display get projection] eq "Orthographic"} { display projection [dict get $saved projection] }
        restore_view [dict get $saved view]
        if {![dict exists $saved turned]} return
        dict for {mol state} [dict get $saved view molecules] {
            if {$mol in [molinfo list] && ![molinfo $mol get fixed]} {
                molinfo $mol set rotate_matrix [dict get $saved turned]
            }
        }
    }
}
