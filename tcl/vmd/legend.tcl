# legend.tcl: the colour bar of a drawing: a graphics molecule fixed on the screen.

namespace eval ::espdiff {
    # In units of half the window's height, from its centre: position and size of the bar, baselines of the texts. The
    # bar is at the bottom centre. VMD's view has the same height in any window, so only a window narrower than high
    # would crop it; there all of it is made narrower.
    variable legend_layout {half_width 0.62 bottom -0.845 top -0.805 ticks -0.905 title -0.775 key -0.965}
    variable legend_titles {
        difference "Potential difference, target - source" source "Potential of the source"
        target "Potential of the target" potential "Potential" displacement "Displacement"
        slip "Slip, distance from where the atoms went"
        path_length "Path length" why "Where it is trusted, and why not elsewhere"
        sign "Sign of the potential, target against source"
    }

    # By id of the graphics molecule: handle, and its centre in units of half the window's width.
    variable legends [dict create]

    # `plan` comes from drawing_plan. The legend's centre, and half of its space, are in units of half the window's
    # width. Returns the molecule's id; its list is not built yet.
    proc draw_legend {plan {middle 0} {room 1}} {
        variable legend_layout
        set mol [new_legend [dict get $plan handle] [graphics_name [dict get $plan handle] legend] $middle]
        set layout $legend_layout
        dict with layout {
            set room [expr {$room * [lindex [legend_screen] 2]}]
            set half_width [expr {min($half_width, 0.82 * $room)}]
            set positions [expr {[dict exists $plan reasons] ? "" : [tick_positions $plan $half_width]}]
            if {[dict exists $plan reasons]} {
                draw_reasons $mol [dict get $plan reasons] $room $bottom $ticks
            } else {
                draw_bar $mol $half_width $bottom $top [value_or $plan first 33]
                graphics $mol color [legend_text_color]
                draw_ticks $mol $positions $bottom
            }
            graphics $mol color [legend_text_color]
            set text [legend_title $plan]
            draw_text $mol $text 0 $title [expr {0.95 * [text_size_within $text 1.0 $room]}]
            set size [expr {0.85 * max(0.65, min(1.0, 1.6 * $room))}]
            foreach {x label} $positions { draw_text $mol $label $x $ticks $size }
            set text [value_or $plan key ""]
            if {$text ne ""} {
                draw_text $mol $text 0 $key [text_size_within $text 0.75 $room]
            }
        }
        return $mol
    }

    # Draws the names of panels at the window's top; `titles` has their places, in half widths of it, and texts.
    proc draw_panel_titles {handle titles} {
        set mol [new_legend $handle [graphics_name $handle titles] 0]
        graphics $mol color [legend_text_color]
        set size [panel_title_size [dict values $titles]]
        set aspect [lindex [legend_screen] 2]
        dict for {middle text} $titles { draw_text $mol $text [expr {$middle * $aspect}] 0.9 $size }
        build_list $mol
        return $mol
    }

    # The size at which all titles fit into a third of the window's width.
    proc panel_title_size {titles} {
        set most 0
        foreach title $titles { set most [expr {max($most, [text_width $title])}] }
        expr {min(1.0, [lindex [legend_screen] 2] * 2 / 3.0 / ($most + 0.05))}
    }

    # A graphics molecule that is fixed on the screen by place_legends.
    proc new_legend {handle name middle} {
        variable legends
        set mol [mol load graphics $name]
        dict set legends $mol [list $handle $middle]
        # The bar's colours unchanged, without light and shade; ray tracers need a material for that.
        graphics $mol materials off
        graphics $mol material [flat_material]
        trace remove variable ::vmd_logfile write ::espdiff::on_vmd_command
        trace add variable ::vmd_logfile write ::espdiff::on_vmd_command
        return $mol
    }

    proc flat_material {} {
        set name EspdiffFlat
        if {$name ni [material list]} {
            material add $name copy Opaque
            foreach {property value} {ambient 1.0 diffuse 0.0 specular 0.0 shininess 0.0} {
                material change $property $name $value
            }
        }
        return $name
    }

    # Moves a legend to its position on the screen and fixes it there. The legends of several drawings stand above each
    # other: `row` is counted from the bottom.
    proc place_legend {mol middle row} {
        lassign [legend_screen] unit z aspect
        set y [expr {0.28 * $row * $unit}]
        set x [expr {$middle * $aspect * $unit}]
        mol free $mol
        molinfo $mol set center_matrix {{{1 0 0 0} {0 1 0 0} {0 0 1 0} {0 0 0 1}}}
        molinfo $mol set rotate_matrix {{{1 0 0 0} {0 1 0 0} {0 0 1 0} {0 0 0 1}}}
        molinfo $mol set scale_matrix [list [list [list $unit 0 0 0] [list 0 $unit 0 0] [list 0 0 $unit 0] {0 0 0 1}]]
        molinfo $mol set global_matrix [list [translation_matrix [list $x $y $z]]]
        mol fix $mol
    }

    proc place_legends {} {
        variable legends
        set rows {}
        dict for {mol place} $legends {
            if {$mol ni [molinfo list]} { dict unset legends $mol; dict unset ::espdiff::drawn_texts $mol; continue }
            lassign $place handle middle
            if {[regexp { (titles|note)$} [lindex [molinfo $mol get name] 0]]} { place_legend $mol $middle 0; continue }
            # Those of linked views stand beside each other; a drawing's and its atoms' colours do not.
            incr taken($handle,$middle)
            set row [list $handle $taken($handle,$middle)]
            if {$row ni $rows} { lappend rows $row }
            place_legend $mol $middle [lsearch -exact $rows $row]
        }
        if {[dict size $legends] == 0} { trace remove variable ::vmd_logfile write ::espdiff::on_vmd_command }
    }

    # Legends name their comparison while several are drawn.
    proc name_legends {} {
        variable drawn_plans
        set several [expr {[dict size $drawn_plans] > 1}]
        dict for {handle plan} $drawn_plans {
            set old [lindex [drawing_of $handle] end]
            if {[dict exists $plan name] == $several || $old ni [molinfo list]} continue
            replace_legend $handle [expr {$several ? [dict set plan name [comparison_name $handle]]
                : [dict remove $plan name]}]
        }
        place_legends
    }

    # Draws the legend of a drawing again, which is its last molecule.
    proc replace_legend {handle plan} {
        variable drawings
        variable drawn_plans
        set old [lindex [drawing_of $handle] end]
        if {$old ni [molinfo list]} return
        dict set drawn_plans $handle $plan
        keep_view {
            with_color_scale [dict get $plan colors] { build_list [set mol [draw_legend $plan]] }
            if {![molinfo $old get displayed]} { mol off $mol }
            dict set drawings $handle [lreplace [drawing_of $handle] end end $mol]
            delete_molecules [list $old]
        }
    }

    # VMD writes each command that changed something into ::vmd_logfile. Resetting the view centres even fixed molecules
    # (VMD 1.9.4), changes of the display move the fixed legend, and after a deletion VMD may make a legend the top
    # molecule and centre the view about it.
    proc on_vmd_command {args} {
        variable legends
        # An error here would make the user's command fail.
        catch {
            if {[regexp {^display (?:resetview|resize|height|distance)} $::vmd_logfile]} { place_panels }
            if {[regexp {^display (?!update)} $::vmd_logfile]} { place_legends }
            if {[string match "mol delete*" $::vmd_logfile] && [dict exists $legends [molinfo top]]} {
                choose_another_top
            }
        }
    }

    proc choose_another_top {} {
        variable legends
        set best ""
        foreach mol [molinfo list] {
            if {[dict exists $legends $mol]} continue
            if {$best eq "" || [molinfo $mol get numatoms] > 0} { set best $mol }
        }
        if {$best ne ""} { mol top $best }
    }

    # Half the window's height at the legend's depth, in VMD's coordinates; the depth, just behind the near clipping
    # plane, so that molecules are behind it; the window's aspect ratio, width by height.
    proc legend_screen {} {
        lassign [display get size] width height
        set aspect [expr {$height > 0 ? double($width) / $height : 1.0}]
        set z [expr {[lindex [display get eyepos] 2] - 1.05 * [display get nearclip]}]
        return [list [half_window $z] $z $aspect]
    }

    # Draws the colour scale, ids 33 to 1056, or from a later one, in segments between which VMD interpolates colours.
    proc draw_bar {mol half_width bottom top first} {
        set n 64
        for {set i 0} {$i < $n} {incr i} {
            set corners {}
            set ids {}
            foreach step [list $i [expr {$i + 1}]] {
                set x [expr {$half_width * (2.0 * $step / $n - 1)}]
                lappend corners [list $x $bottom 0] [list $x $top 0]
                lappend ids [expr {$first + ((1056 - $first) * $step) / $n}]
            }
            lassign $corners a b c d
            lassign $ids left right
            graphics $mol tricolor $a $c $d {0 0 1} {0 0 1} {0 0 1} $left $right $right
            graphics $mol tricolor $a $d $b {0 0 1} {0 0 1} {0 0 1} $left $right $left
        }
    }

    # A square and words for each reason, in two rows where one has no room.
    proc draw_reasons {mol reasons room first second} {
        variable reason_colors
        set entries {}
        foreach {reason words area} $reasons {
            lappend entries [list [lindex $reason_colors $reason] "$words [format %.3g [expr {100 * $area}]] %"]
        }
        set n [llength $entries]
        set in_first [expr {$n > 3 ? ($n + 1) / 2 : $n}]
        foreach row [list [lrange $entries 0 $in_first-1] [lrange $entries $in_first end]] y [list $first $second] {
            set all ""
            foreach entry $row { append all [lindex $entry 1] "     " }
            set size [text_size_within $all 0.85 $room]
            set square [expr {0.05 * $size}]
            set width 0
            foreach entry $row { set width [expr {$width + 4 * $square + $size * [text_width [lindex $entry 1]]}] }
            set x [expr {-0.5 * $width}]
            foreach entry $row {
                lassign $entry color words
                graphics $mol color $color
                set corners {}
                foreach {dx dy} [list 0 0 0 $square $square 0 $square $square] {
                    lappend corners [list [expr {$x + $dx}] [expr {$y + $dy}] 0]
                }
                lassign $corners a b c d
                graphics $mol triangle $a $c $d
                graphics $mol triangle $a $d $b
                set length [expr {$size * [text_width $words]}]
                graphics $mol color [legend_text_color]
                draw_text $mol $words [expr {$x + 1.6 * $square + 0.5 * $length}] $y $size
                set x [expr {$x + 4 * $square + $length}]
            }
        }
    }

    # Triangles, because lines have no width in ray tracers.
    proc draw_ticks {mol positions bottom} {
        set half 0.0022
        set low [expr {$bottom - 0.015}]
        foreach {x label} $positions {
            set left [expr {$x - $half}]
            set right [expr {$x + $half}]
            graphics $mol triangle [list $left $bottom 0] [list $left $low 0] [list $right $low 0]
            graphics $mol triangle [list $left $bottom 0] [list $right $low 0] [list $right $bottom 0]
        }
    }

    # Where ticks stand, and their labels; three if there is no room for five.
    proc tick_positions {plan half_width} {
        set positions {}
        foreach {share label} [tick_labels $plan] {
            if {$half_width < 0.3 && abs($share) == 0.5} continue
            lappend positions [expr {$share * $half_width}] $label
        }
        return $positions
    }

    # Positions from -1 (left end) to 1, and their labels.
    proc tick_labels {plan} {
        if {[dict get $plan color] eq "sign"} { return {-1 "+ to -" 0 "same" 1 "- to +"} }
        set labels {}
        foreach share {-1 -0.5 0 0.5 1} {
            set value [expr {0.5 * ((1 - $share) * [dict get $plan low] + (1 + $share) * [dict get $plan high])}]
            lappend labels $share [format %.3g $value]
        }
        return $labels
    }

    # The size at which a text fits into the window, or into half the width `room`; at most `size`.
    proc text_size_within {text size {room ""}} {
        if {$room eq ""} { set room [lindex [legend_screen] 2] }
        expr {min($size, 2 * $room / ([text_width $text] + 0.1))}
    }

    proc legend_title {plan} {
        variable legend_titles
        set title [value_or $plan title [value_or $legend_titles [dict get $plan color] ""]]
        if {[dict exists $plan name]} { set title "[dict get $plan name]: [string tolower $title 0 0]" }
        set unit [dict get $plan unit]
        if {$unit eq ""} { return $title }
        if {$unit eq "unknown"} { set unit "unit unknown" }
        return "$title ($unit)"
    }

    # "wild -> mutant #97", where #97 is a frame, from what a comparison was made of.
    proc comparison_name {handle} {
        if {[dict get [core::status $handle] kind] ne "comparison"} { return $handle }
        return "[side_name $handle source] -> [side_name $handle target]"
    }

    # The molecule of one side of a comparison by its file, with the frame if it is not the first.
    proc side_name {handle side} {
        foreach input [dict get [core::result $handle] inputs] {
            if {[dict get $input role] ne $side} continue
            set name [dict get $input path]
            # Format of VMD's molecules: mol 0 "ubq.psf" frame 5 sel "not water"
            set frame 0
            regexp {^mol \d+ "(.*)" frame (\d+)} $name -> name frame
            return "[file rootname [file tail $name]][expr {$frame == 0 ? "" : " #$frame"}]"
        }
        return $side
    }

    # White on a dark background, black on a bright one.
    proc legend_text_color {} {
        lassign [colorinfo rgb [color Display Background]] red green blue
        expr {0.3 * $red + 0.6 * $green + 0.1 * $blue > 0.5 ? "black" : "white"}
    }
}
