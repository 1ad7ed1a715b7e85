# picked.tcl: a click on a drawn surface: residue, potentials, difference and slip there, in the view and in the window.
#
# VMD picks in its mouse modes Mouse > Label (keys 1 to 4): it has no triangles to pick, so each vertex of a drawing is a
# point that is not seen. The line of sight through the picked one meets the surface where the user sees it.

namespace eval ::espdiff {
    variable pick_surfaces [dict create]  ;# by graphics molecule: handle, mapped or source
    variable picked {}  ;# handle, molecules of the mark; empty for none

    # Lets a click on this part of a drawing, the one that has all of its vertices, find them.
    proc add_pick_points {handle mol surface} {
        variable pick_surfaces
        if {[dict get [core::status $handle] kind] ne "comparison"} return
        core::pick_points $handle $mol $surface
        foreach other [dict keys $pick_surfaces] {
            if {$other ni [molinfo list]} { dict unset pick_surfaces $other }
        }
        dict set pick_surfaces $mol [list $handle $surface]
        trace remove variable ::vmd_pick_graphics write ::espdiff::on_surface_pick
        trace add variable ::vmd_pick_graphics write ::espdiff::on_surface_pick
    }

    # VMD writes "MOLECULE TAG BUTTON SHIFT" for a point that is picked in a graphics molecule.
    proc on_surface_pick {args} {
        variable pick_surfaces
        # An error here would make VMD's own handling of the click fail.
        if {[catch {
            lassign $::vmd_pick_graphics mol tag
            if {[dict exists $pick_surfaces $mol]} { tell_picked $mol $tag }
        } message]} { say $message }
    }

    proc tell_picked {mol tag} {
        variable pick_surfaces
        lassign [dict get $pick_surfaces $mol] handle surface
        # "pickpoint {X Y Z} TAG"
        set point [lindex [graphics $mol info $tag] 1]
        set seen [core::seen_point $handle $surface [eye_of $mol $point] $point]
        if {$seen eq ""} { forget_picked; return }
        set text [picked_words $handle $seen]
        show_picked $handle $mol [dict get $seen position] $text
        vmdcon -info "espdiff) $text"
        if {[info commands ::espdiff::gui::show_picked] ne ""} { gui::show_picked $handle $text }
    }

    # Where the viewer's eye is, in a molecule's own coordinates; far in front of the point in a parallel projection.
    # VMD centres a point, rotates, scales and moves it, and looks along -z.
    proc eye_of {mol point} {
        lassign [molinfo $mol get {center_matrix rotate_matrix scale_matrix global_matrix}] center rotation scale global
        set toward [lrange [lindex $rotation 2] 0 2]
        if {[display get projection] eq "Orthographic"} { return [vecadd $point [vecscale 1e4 $toward]] }
        set away [vecscale [expr {1.0 / [lindex $scale 0 0]}] [vecsub [display get eyepos] [matrix_translation $global]]]
        set eye [vecscale -1 [matrix_translation $center]]
        foreach axis {0 1 2} part $away {
            set eye [vecadd $eye [vecscale $part [lrange [lindex $rotation $axis] 0 2]]]
        }
        return $eye
    }

    # "A:ASP25->LEU26: source -1.2, target 3.4, difference 4.6 kT/e, slip 0.3 A"
    proc picked_words {handle seen} {
        set where "no residue"
        foreach row [core::residues $handle] {
            if {[dict get $row index] == [dict get $seen residue]} { set where [residue_name $row]; break }
        }
        if {![dict get $seen matched]} { append where " (unmatched)" }
        set words {}
        lassign [list [dict get $seen source] [dict get $seen target]] source target
        if {$source ne ""} { lappend words "source [format %.3g $source]" }
        if {$target ne ""} { lappend words "target [format %.3g $target]" }
        if {$source ne "" && $target ne ""} { lappend words "difference [format %.3g [expr {$target - $source}]]" }
        if {$words ne ""} { lset words end "[lindex $words end] [dict get [core::result $handle] potential_unit]" }
        foreach quantity {slip displacement} {
            if {[dict get $seen $quantity] eq ""} continue
            lappend words "$quantity [format %.2g [dict get $seen $quantity]] A"
            break
        }
        return "$where: [join $words {, }]"
    }

    # A ball at the place, and the words at the window's top.
    proc show_picked {handle mol place text} {
        variable picked
        forget_picked
        keep_view {
            set ball [new_graphics [graphics_name $handle picked] $mol]
            graphics $ball material [material_of 1.0]
            graphics $ball color yellow
            graphics $ball sphere $place radius 0.7 resolution 20
            set note [new_legend $handle [graphics_name $handle "picked note"] 0]
            graphics $note color [legend_text_color]
            draw_text $note $text 0 0.74 [text_size_within $text 0.9]
            build_list $note
        }
        set picked [list $handle [list $ball $note]]
        place_legends
    }

    proc forget_picked {} {
        variable picked
        if {$picked eq ""} return
        set molecules [lindex $picked 1]
        set picked {}
        keep_view { delete_molecules $molecules }
        place_legends
    }

    # Called when a drawing goes.
    proc forget_pick_points {handle} {
        variable pick_surfaces
        variable picked
        if {[lindex $picked 0] eq $handle} forget_picked
        set now [molinfo list]
        dict for {mol place} $pick_surfaces {
            if {$mol ni $now || [lindex $place 0] eq $handle} { dict unset pick_surfaces $mol }
        }
        if {[dict size $pick_surfaces] == 0} {
            trace remove variable ::vmd_pick_graphics write ::espdiff::on_surface_pick
        }
    }
}
