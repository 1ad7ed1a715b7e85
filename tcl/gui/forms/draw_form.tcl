# draw_form.tcl: how a result is drawn in VMD.

namespace eval ::espdiff::gui {
    variable form
    array set form {
        draw,color difference draw,field potential draw,surface target draw,range auto draw,low -5 draw,high 5
        draw,uncertain fade draw,limit 2.0 draw,off_target uncertain draw,legend 1 draw,colors red-blue draw,view single draw,mol "" draw,keep 0
        draw,pick 0
    }
    variable recolouring ""  ;# the `after` script that recolours a drawing
    variable drawn_on {target mapped source source}  ;# the window's word, espdiff's word

    proc build_draw {path} {
        variable widget
        ttk::labelframe $path -text Draw -padding {6 3}
        set variable ::espdiff::gui::form
        ttk::frame $path.what
        ttk::combobox $path.what.color -textvariable ${variable}(draw,color) -state readonly -width 12 \
            -values {difference sign source target slip displacement path_length why none}
        ttk::label $path.what.of -text of
        ttk::combobox $path.what.field -textvariable ${variable}(draw,field) -state readonly -width 10 -values potential
        foreach name {color field} {
            bind $path.what.$name <<ComboboxSelected>> {::espdiff::gui::guard ::espdiff::gui::update_draw}
        }
        form_row $path 0 "Colour by" $path.what ""
        tip $path.what.color "difference: target - source;\
            sign: where it changed; source, target: the potentials; slip: how far each point is from where its own\
            atoms went; displacement: how far each point travelled,\
            path_length: the path length; why: where it is trusted, and why not"
        tip $path.what.field "What differs: the potential, or a field that was compared (Settings, Input, Field)"
        pack $path.what.color -side left -fill x -expand 1
        ttk::combobox $path.surface -textvariable ${variable}(draw,surface) -state readonly -width 12 \
            -values {target source}
        form_row $path 0 "on the" $path.surface "Surface to colour: mapped onto the target, or on the source" 2
        build_range $path.range
        form_row $path 1 Range $path.range "Values at the ends of the colour scale. Automatic: symmetric about 0, holds\
            90 % of the surface's points. The slider recolours the drawing at once"
        grid configure $path.range -columnspan 3
        ttk::frame $path.look
        ttk::label $path.look.uncertain -text "Uncertain parts"
        ttk::combobox $path.look.style -textvariable ${variable}(draw,uncertain) -state readonly -width 11 \
            -values {fade transparent plain}
        ttk::label $path.look.from -text "from"
        ttk::spinbox $path.look.limit -textvariable ${variable}(draw,limit) -width 5 -from 0.5 -to 20 -increment 0.5
        ttk::label $path.look.unit -text "\u00c5"
        foreach name {uncertain style} {
            tip $path.look.$name "fade: colours fade into grey the larger a point's slip is; transparent: the\
                surface does; plain: full colours"
        }
        tip $path.look.limit "Slip at which colours have faded completely; below half of it nothing fades"
        ttk::checkbutton $path.look.legend -text Legend -variable ${variable}(draw,legend)
        tip $path.look.legend "A colour bar at the bottom of VMD's window"
        pack $path.look.uncertain $path.look.style $path.look.from $path.look.limit $path.look.unit -side left -padx {0 4}
        ttk::combobox $path.look.colors -textvariable ${variable}(draw,colors) -state readonly -width 13 \
            -values {red-blue cool-warm purple-orange}
        tip $path.look.colors "Colours of signed values, from negative to positive; colour-blind readers can tell the\
            ends of each apart"
        pack $path.look.colors $path.look.legend -side right -padx {4 0}
        set widget(draw,colors) $path.look.colors
        grid $path.look -row 2 -column 0 -columnspan 4 -sticky ew -pady 2
        ttk::combobox $path.corrupt -textvariable ${variable}(draw,off_target) -state readonly -width 12 \
            -values {uncertain mark hide}
        form_row $path 3 "Corrupt parts" $path.corrupt "Parts that are off the target's surface: as uncertain as can be,\
            marked in yellow, or not drawn"
        ttk::frame $path.views
        ttk::checkbutton $path.views.keep -text "Keep the others" -variable ${variable}(draw,keep)
        tip $path.views.keep "Do not remove the drawings of other results"
        ttk::checkbutton $path.views.linked -text "Side by side" \
            -variable ::espdiff::gui::form(draw,view) -onvalue linked -offvalue single
        tip $path.views.linked "Linked views of source, target and this: the mouse turns all three; both potentials on the left, what is chosen here on\
            the right. Undraw puts VMD's view back"
        ttk::checkbutton $path.views.pick -text "Name clicks" -variable ${variable}(draw,pick) \
            -command {::espdiff::gui::guard ::espdiff::gui::set_mouse_mode}
        tip $path.views.pick "A click on the surface names its residue, both potentials, their difference and the slip:\
            VMD's mouse mode Label > Atoms (key 1). Without it the mouse turns the view (key r)"
        pack $path.views.linked $path.views.keep $path.views.pick -side left -padx {0 10}
        grid $path.views -row 3 -column 2 -columnspan 2 -sticky w -padx {16 0}
        foreach name {linked pick} { set widget(draw,$name) $path.views.$name }
        build_draw_buttons $path.buttons
        grid $path.buttons -row 4 -column 0 -columnspan 4 -sticky ew -pady {4 0}
        grid configure $path.label_surface -padx {16 6}
        grid columnconfigure $path {1 3} -weight 1
        foreach name {surface corrupt} { set widget(draw,$name) $path.$name }
        foreach name {color of field} { set widget(draw,$name) $path.what.$name }
        foreach name {low high} { set widget(draw,$name) $path.range.$name }
    }

    proc build_range {path} {
        ttk::frame $path
        ttk::radiobutton $path.auto -text automatic -value auto -variable ::espdiff::gui::form(draw,range)
        ttk::radiobutton $path.given -text from -value given -variable ::espdiff::gui::form(draw,range)
        ttk::entry $path.low -textvariable ::espdiff::gui::form(draw,low) -width 7
        ttk::label $path.to -text to
        ttk::entry $path.high -textvariable ::espdiff::gui::form(draw,high) -width 7
        ttk::label $path.unit
        ttk::scale $path.slider -from -1 -to 1 -length 60 -command ::espdiff::gui::slide_range
        pack $path.auto $path.given $path.low $path.to $path.high $path.unit -side left -padx {0 6}
        pack $path.slider -side left -fill x -expand 1
        tip $path.slider "From a tenth to ten times the automatic range; the drawing is recoloured at once"
        foreach entry {low high} {
            $path.$entry configure -validate key -validatecommand {set ::espdiff::gui::form(draw,range) given; expr 1}
            bind $path.$entry <Return> {::espdiff::gui::press draw; break}
        }
        set ::espdiff::gui::widget(draw,unit) $path.unit
    }

    proc set_mouse_mode {} {
        variable form
        mouse mode [expr {$form(draw,pick) ? "labelatom" : "rotate"}]
    }

    # VMD's keys and menu change it too.
    proc notice_mouse_mode {args} {
        variable form
        set form(draw,pick) [string match "label*" $::vmd_mouse_mode]
    }

    # What a click on the surface hit.
    proc show_picked {handle text} { show_message "$handle, [string map {-> \u2192} $text]" }

    # The slider's place is the logarithm of the range, in automatic ranges.
    proc slide_range {place} {
        variable form
        variable shown
        variable recolouring
        if {$shown eq "" || $form(draw,color) in {sign why none}} return
        lassign [dict values [::espdiff::drawn_range $shown [chosen_quantity] auto]] low high
        set factor [expr {10.0 ** $place}]
        foreach {end value} [list low $low high $high] {
            set form(draw,$end) [format %.3g [expr {$factor * $value}]]
        }
        set form(draw,range) given
        after cancel $recolouring
        set recolouring [after 40 {::espdiff::gui::guard ::espdiff::gui::recolour}]
    }

    proc recolour {} {
        variable shown
        if {$shown in [espdiff handles] && [::espdiff::drawing_of $shown] ne ""} draw
    }

    proc build_draw_buttons {path} {
        variable widget
        ttk::frame $path
        button $path.undraw Undraw ::espdiff::gui::undraw 0
        button $path.picture Picture... ::espdiff::gui::save_picture 0
        button $path.map "Add map to" ::espdiff::gui::add_map 0
        ttk::combobox $path.mol -textvariable ::espdiff::gui::form(draw,mol) -state readonly -width 18 \
            -postcommand {::espdiff::gui::guard ::espdiff::gui::update_draw}
        tip $path.undraw "Remove this result's drawing"
        tip $path.picture "A figure for print in VMD's view (PNG), or VMD's window as it is (Targa)"
        tip $path.map "Add what is chosen under Colour by as a volumetric map to this molecule, for Color Volume and\
            Isosurface representations"
        tip $path.mol "Molecule that gets the map"
        grid $path.undraw $path.picture $path.map $path.mol -sticky ew -padx {0 6}
        grid configure $path.map -padx {16 6}
        grid configure $path.mol -padx 0
        grid columnconfigure $path 3 -weight 1
        foreach name {undraw picture map} { set widget($name) $path.$name }
        set widget(draw,mol) $path.mol
    }

    # Updates what can be drawn of the shown result, and the molecules that can take a map.
    proc update_draw {} {
        variable form
        variable widget
        variable shown
        set is_shown [expr {$shown ne "" && $shown in [espdiff handles]}]
        set_enabled $is_shown $widget(draw) $widget(undraw) $widget(map)
        set unit [expr {$is_shown ? [potential_unit] : ""}]
        set has_potentials [expr {$unit ne "" || !$is_shown}]
        set fields [expr {$is_shown ? [dict get [espdiff result $shown] fields] : {}}]
        offer_fields [concat [expr {$has_potentials ? "potential" : ""}] [dict keys $fields]]
        set colors {slip displacement path_length why none}
        if {[dict exists $fields $form(draw,field)]} {
            set field [dict get $fields $form(draw,field)]
            set unit [dict get $field unit]
            set colors [concat difference [expr {[dict get $field signed] ? "sign" : ""}] {source target} $colors]
        } elseif {$has_potentials} {
            set colors [concat {difference sign source target} $colors]
        }
        $widget(draw,color) configure -values $colors
        if {$form(draw,color) ni $colors} { set form(draw,color) slip }
        switch $form(draw,color) {
            slip - displacement - path_length { set unit "\u00c5" }
            sign - why - none { set unit "" }
        }
        $widget(draw,unit) configure -text $unit
        set names [molecule_names]
        $widget(draw,mol) configure -values $names
        if {$form(draw,mol) ni $names} {
            set form(draw,mol) [expr {$form(target,mol) in $names ? $form(target,mol) : [lindex $names 0]}]
        }
    }

    # Which field is drawn can be chosen where there are several.
    proc offer_fields {names} {
        variable form
        variable widget
        $widget(draw,field) configure -values $names
        if {$form(draw,field) ni $names} { set form(draw,field) [lindex [concat $names potential] 0] }
        pack forget $widget(draw,of) $widget(draw,field)
        if {[llength $names] > 1 || [lindex [concat $names potential] 0] ne "potential"} {
            pack $widget(draw,of) $widget(draw,field) -side left -padx {4 0}
        }
    }

    # The field that the form draws; empty for the potential, and for what no field has.
    proc chosen_field {} {
        variable form
        expr {$form(draw,field) eq "potential" || $form(draw,color) ni {difference sign source target} ? "" : $form(draw,field)}
    }

    # As the core names it.
    proc chosen_quantity {} {
        variable form
        set field [chosen_field]
        expr {$field eq "" ? $form(draw,color) : "$field:$form(draw,color)"}
    }

    # The form as options of `espdiff draw`, without defaults.
    proc draw_options {} {
        variable form
        variable drawn_on
        set options [list -color $form(draw,color)]
        if {[chosen_field] ne ""} { lappend options -field [chosen_field] }
        if {$form(draw,range) eq "given"} {
            lappend options -range [list [string trim $form(draw,low)] [string trim $form(draw,high)]]
        }
        if {$form(draw,uncertain) ne "fade"} { lappend options -uncertain $form(draw,uncertain) }
        if {$form(draw,uncertain) ne "plain" && $form(draw,limit) ne "2.0"} {
            lappend options -uncertainty-limit $form(draw,limit)
        }
        if {$form(draw,colors) ne "red-blue"} { lappend options -colors $form(draw,colors) }
        if {$form(draw,off_target) ne "uncertain"} { lappend options -corrupt $form(draw,off_target) }
        if {$form(draw,surface) ne "target"} { lappend options -surface [dict get $drawn_on $form(draw,surface)] }
        if {!$form(draw,legend)} { lappend options -legend 0 }
        if {$form(draw,view) ne "single"} { lappend options -view $form(draw,view) }
        if {$form(draw,keep)} { lappend options -keep 1 }
        return $options
    }

    proc draw {} {
        variable shown
        set options [draw_options]
        set molecules [espdiff draw $shown {*}$options]
        remember $shown draw [concat draw $options]
        show_message "$shown is drawn (molecules [join $molecules {, }])."
    }

    proc undraw {} {
        variable shown
        espdiff undraw $shown
        forget $shown draw
        show_message "The drawing of $shown is removed."
    }

    proc save_picture {} {
        variable window
        variable shown
        set path [tk_getSaveFile -parent $window -title "A figure for print, or VMD's window as it is" \
            -initialfile $shown.png -defaultextension .png \
            -filetypes {{"Figure for print, in VMD's view" .png} {"VMD's window as it is" .tga}}]
        if {$path ne ""} { save_picture_as $path }
    }

    # VMD reports nothing if it cannot write.
    proc save_picture_as {path} {
        variable shown
        if {[string tolower [file extension $path]] eq ".png"} {
            espdiff figure $shown $path -overwrite 1
            show_message "Written: $path"
            return
        }
        file delete $path
        display update
        render snapshot $path
        if {![file exists $path]} { error "VMD could not write '$path'; see its console" }
        show_message "Written: $path"
    }

    proc add_map {} {
        variable form
        variable shown
        set mol [number_of $form(draw,mol)]
        if {$mol eq ""} { error "there is no molecule to add the map to; load one into VMD" }
        if {$form(draw,color) eq "none"} { error "choose the map's quantity under Colour by" }
        set k [espdiff map $shown -quantity $form(draw,color) -mol $mol]
        remember $shown map.$form(draw,color).$mol [list map -quantity $form(draw,color) -mol $mol]
        show_message "The map of $form(draw,color) is data set $k of molecule $form(draw,mol)."
    }
}
