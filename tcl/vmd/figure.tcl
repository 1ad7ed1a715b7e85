# figure.tcl: what VMD shows of a comparison as a picture for print, drawn by `espdiff render` with VMD's camera.

namespace eval ::espdiff {
    # Shares of a picture's height that `espdiff render` keeps for them.
    variable figure_margins {legend 0.19 head 0.045 title 0.075 names 0.03}  ;# as scene_legend.cpp has them
    variable figure_quantities {difference source target sign slip displacement}

    proc figure {options handle path} {
        variable figure_quantities
        require_vmd "espdiff figure" "outside of it the command line's `espdiff render` draws an exported comparison"
        require_core_handle $handle
        if {[dict get [core::status $handle] kind] ne "comparison"} {
            fail "espdiff figure: $handle is a [dict get [core::status $handle] kind]; figures are of comparisons"
        }
        if {[string tolower [file extension $path]] ne ".png"} {
            fail "espdiff figure: '$path' does not end in .png, the only format; VMD's own `render` writes others"
        }
        set program [program_path]
        if {$program eq ""} {
            fail "espdiff figure: the program espdiff is not found; install it whole (cmake --install BUILD), put it on\
                PATH, or name it in the environment variable ESPDIFF_PROGRAM" IO
        }
        core::check_outputs {} [list [file normalize $path]] [dict get $options overwrite]
        set drawn [drawn_as $handle]
        set color [drawn_quantity $handle [dict get $drawn color] 0]
        if {$color eq "none"} { set color plain }
        if {$color ni [concat $figure_quantities plain]} {
            fail "espdiff figure: figures have no $color; draw one of [join_words $figure_quantities or] first"
        }
        set folder [temporary_folder]
        finally {
            set surface [export_for_viewer $folder $handle]
            set scene [file join $folder scene.json]
            write_text $scene [camera_json $handle [dict get $drawn surface]]
            run_to_end $program [concat [list render $surface -o [file normalize $path] --overwrite --scene $scene] \
                [figure_words $handle $color $drawn $options]]
        } { file delete -force $folder }
        return $path
    }

    # The options of the handle's drawing, otherwise the usual ones.
    proc drawn_as {handle} {
        variable drawn_options
        if {[drawing_of $handle] ne ""} { return [dict get $drawn_options $handle] }
        foreach option [options_of draw] {
            dict set usual [string range [dict get $option name] 1 end] [dict get $option default]
        }
        return $usual
    }

    # Width and height in pixels: as wide as was asked for; the view has the proportions of VMD's window, and legend and
    # title stand below and above it.
    proc figure_size {options drawn} {
        variable figure_margins
        lassign [display get size] width height
        set view 1.0
        if {[dict get $drawn legend]} {
            set view [expr {$view - [dict get $figure_margins legend] - [dict get $figure_margins head]}]
            if {[dict get $drawn view] eq "linked"} { set view [expr {$view - [dict get $figure_margins names]}] }
            if {[dict get $options title] ne ""} { set view [expr {$view - [dict get $figure_margins title]}] }
        }
        set wide [dict get $options width]
        set high [expr {round(double($wide) * $height / $width / $view)}]
        list $wide [expr {max(400, min(6000, $high))}]
    }

    # What is drawn how, as options of `espdiff render`.
    proc figure_words {handle color drawn options} {
        lassign [figure_size $options $drawn] width height
        set words [expr {[dict get $drawn view] eq "linked" ? {--layout linked} : {--views 1}}]
        if {[dict get $drawn surface] eq "source"} { lappend words --morph 0 }
        lappend words {*}[list --color $color --colors [dict get $drawn colors] --width $width --height $height \
            --molecule [dict get $options molecule]]
        if {$color ni {sign plain}} {
            set range [drawn_range $handle $color [shared_range $drawn $handle $color]]
            lappend words --range [dict get $range low]:[dict get $range high]
        }
        if {[dict get $drawn uncertain] eq "plain"} {
            lappend words --opaque
        } else {
            set limit [dict get $drawn uncertainty-limit]
            lappend words --opaque-below [expr {0.5 * $limit}] --faint-above $limit
            if {[dict get $drawn uncertain] eq "fade"} { lappend words --fade-to-grey }
        }
        if {![dict get $drawn legend]} { lappend words --no-legend }
        if {[dict get $options title] ne ""} { lappend words --title [dict get $options title] }
        return $words
    }

    # VMD's camera in the frame of the target, as the scene file of `espdiff render` has it, from the molecule whose surface
    # is drawn (mapped or source). VMD centres a point, rotates, scales and moves it; it looks along -z.
    proc camera_json {handle surface} {
        set is_source [expr {$surface eq "source"}]
        set mol [molecule_of $handle [expr {$is_source ? "source" : "target"}]]
        if {$mol eq ""} { set mol [lindex [drawing_of $handle] 0] }
        if {$mol eq "" || $mol ni [molinfo list]} {
            fail "espdiff figure: neither the surface's molecule nor a drawing of $handle is in VMD; draw it first"
        }
        lassign [molinfo $mol get {center_matrix rotate_matrix scale_matrix global_matrix}] center rotation scale global
        foreach axis {0 1 2} {
            lappend centre [expr {-[lindex $center $axis 3]}]
            lappend shift [lindex $global $axis 3]
            lappend right [lindex $rotation 0 $axis]
            lappend up [lindex $rotation 1 $axis]
            lappend toward [lindex $rotation 2 $axis]
        }
        set factor [lindex $scale 0 0]
        lassign $shift x y z
        set centre [vecsub $centre [vecscale [expr {1.0 / $factor}] [vecadd [vecscale $x $right] [vecscale $y $up]]]]
        set half [expr {[half_window $z] / $factor}]
        if {$is_source} {
            set superposition [dict get [core::result $handle] superposition]
            foreach name {centre toward up} { set $name [rotated [dict get $superposition rotation_row_major] [set $name]] }
            set centre [vecadd $centre [dict get $superposition translation_A]]
        }
        return "{\"camera\": {\"centre_A\": [json_list $centre], \"toward_viewer\": [json_list $toward],\
            \"up\": [json_list $up], \"half_height_A\": $half}}"
    }

    # A vector rotated by a matrix of nine entries, row by row.
    proc rotated {matrix vector} {
        list [vecdot [lrange $matrix 0 2] $vector] [vecdot [lrange $matrix 3 5] $vector] \
            [vecdot [lrange $matrix 6 8] $vector]
    }

    # Half the window's height in VMD's coordinates at depth z.
    proc half_window {z} {
        if {[display get projection] eq "Orthographic"} { return [expr {[display get height] / 4.0}] }
        set eye [lindex [display get eyepos] 2]
        expr {0.5 * [display get height] * ($eye - $z) / ($eye - [display get distance])}
    }

    proc json_list {numbers} { return "\[[join $numbers {, }]\]" }

    proc write_text {path text} {
        set channel [open_file $path w]
        finally { puts $channel $text } { close $channel }
    }

    # Runs a program that draws nothing in VMD, to its end; its message is the error.
    proc run_to_end {program words} {
        set log [temporary_file .log]
        set process [core::start_program [concat [list $program] $words] $log]
        while {![viewer_has_ended $process $log "espdiff render"]} { after 30 }
    }
}
