; The household world: what AI2-THOR 5.0 lets agents do to the objects of a room, as facts.
;
; This is the union of all robots: each robot's own domain (robots/*.pddl) is this one without the actions
; it has no skill for. Who reads it first should know five things.
;
; 1. Where robots are. (at r x) means that r stands within reach of x. Going to x brings r to x, to the
;    container x lies in and to whatever lies in x. Every robot is always at the floor it stands on.
; 2. Where things are. (in x c) is direct: x lies in or on c. What is held is nowhere: nobody stands at it.
; 3. What can be reached. A thing is `exposed` while it stands on furniture, or in furniture that is open, and
;    is not held; a container is `accessible` while it has no closed door of its own. Things are put into and
;    taken out of what is exposed and accessible, and worked on (sliced, switched, opened, washed …) while they
;    are exposed: what lies in a bowl can be taken out and nothing else. That keeps every door to one level.
; 4. What appliances do. They act on what lies in them, and on what lies in that (an egg in a pan on a
;    burner), at the moment they are switched on and whenever something is put there while they are on.
; 5. What cannot be undone. Slicing, breaking, cooking. A sliced object keeps its name and its type.
;
; `exposed`, `accessible`, `placed`, `pickupable`, `can-open`, `can-switch-on`, `heating`, `cooling`, `rinsing`
; and `armed` are kept by the actions, so that no precondition needs a disjunction or a look into contents.
; They are never goals.

(define (domain household)
  (:requirements :strips :typing :equality :negative-preconditions :disjunctive-preconditions
                 :universal-preconditions :conditional-effects)

  (:types
    robot crew thing liquid count skill - object ; a crew: robots that can lift something together
    fixture item - thing              ; what stays where it is, and what can be carried
    vessel - item                     ; what can be carried and can hold something
    heater basin - fixture            ; what heats what lies in it, and what a tap runs into
    ; One type for each object type of AI2-THOR 5.0.
    ArmChair Bed Blinds Cabinet Chair CoffeeTable CounterTop Curtains Desk DeskLamp Desktop
    DiningTable DogBed Drawer Dresser Faucet Floor FloorLamp Fridge GarbageBag GarbageCan
    HandTowelHolder HousePlant LaundryHamper LightSwitch Mirror Ottoman Painting Poster RoomDecor
    Safe Shelf ShelvingUnit ShowerCurtain ShowerDoor ShowerGlass ShowerHead SideTable Sofa Stool
    StoveKnob TVStand TargetCircle Television Toilet ToiletPaperHanger TowelHolder VacuumCleaner
    Window - fixture
    AlarmClock AluminumFoil Apple BaseballBat BasketBall Book Boots Bottle Bread ButterKnife CD
    Candle CellPhone Cloth CreditCard DishSponge Dumbbell Egg Fork HandTowel Kettle KeyChain Knife
    Ladle Laptop Lettuce Newspaper PaperTowelRoll Pen Pencil PepperShaker Pillow Plunger Potato
    RemoteControl SaltShaker ScrubBrush SoapBar SoapBottle Spatula Spoon SprayBottle Statue
    TableTopDecor TeddyBear TennisRacket TissueBox ToiletPaper Tomato Towel Vase Watch WateringCan
    WineBottle - item
    Bowl Box Cup Footstool Mug Pan Plate Pot - vessel
    CoffeeMachine Microwave StoveBurner Toaster - heater
    Bathtub Sink - basin
    SinkBasin - Sink BathtubBasin - Bathtub
    AppleSliced - Apple BreadSliced - Bread LettuceSliced - Lettuce PotatoSliced - Potato
    TomatoSliced - Tomato EggCracked - Egg)

  (:constants
    water coffee wine - liquid
    none one two three four - count
    GoToObject PickupObject PutObject OpenObject CloseObject SwitchOn SwitchOff SliceObject BreakObject
    CleanObject DirtyObject FillObject EmptyObject UseUpObject
    DropHandObject ThrowObject PushObject PullObject - skill)

  (:predicates
    ; --- the state that tasks speak of
    (at ?r - robot ?x - thing)
    (holding ?r - robot ?x - item)
    (in ?x - thing ?c - thing)
    (open ?x - thing)
    (toggled ?x - thing)
    (sliced ?x - thing)
    (broken ?x - thing)
    (cooked ?x - thing)
    (dirty ?x - thing)
    (filled ?x - thing)
    (filled-with ?x - thing ?l - liquid)
    (hot ?x - thing)                  ; neither hot nor cold: room temperature
    (cold ?x - thing)
    (used-up ?x - thing)
    (moved ?x - thing)                ; pushed or pulled since the start

    ; --- kept by the actions
    (placed ?x - thing)               ; somewhere one can go; false while it is held
    (exposed ?x - thing)              ; on furniture or in open furniture
    (accessible ?c - thing)           ; has no door, or an open one, and is whole
    (pickupable ?x - thing)           ; not once it is in pieces
    (can-open ?x - thing)             ; not while it runs, for a microwave
    (can-switch-on ?x - thing)        ; not while open, for a microwave; not once broken
    (cookable ?x - thing)             ; bread once sliced, an egg once cracked
    (accepts ?c ?x - thing)           ; a toaster takes bread once sliced
    (heating ?c - thing)              ; what is put here becomes hot, and cooks
    (cooling ?c - thing)              ; what is put here becomes cold
    (rinsing ?c - thing)              ; what is put here becomes clean and full of water
    (hand-free ?r - robot)            ; at least one hand is free
    (free-hands ?r - robot ?n - count) ; how many, for robots with several
    (armed ?r - robot)                ; may slice: holds a knife, or the task asks for none
    (mobile ?r - robot)               ; not bound to another robot by a joint lift
    (supporting ?h - robot ?x - item) ; offers a hand for a joint lift of x
    (helping ?h ?r - robot)           ; carries, together with r, what r holds

    ; --- never changed
    (has ?r - robot ?s - skill)       ; so that a whole team can be planned, and watched, in this one domain
    (openable ?x - thing)
    (encloses ?c - thing)             ; its door shuts its contents in (a toilet's lid does not)
    (fixed ?c - thing)                ; furniture, fixtures and the floor
    (toggleable ?x - thing)
    (sliceable ?x - thing)
    (breakable ?x - thing)
    (shatters ?x - thing)             ; broken, it is in pieces and cannot be picked up
    (dirtyable ?x - thing)
    (fillable ?x - thing)
    (pushable ?x - thing)
    (consumable ?x - thing)           ; soap, tissues, paper: what is used up one day
    (receptacle ?c - thing)
    (heat-source ?c - thing)
    (cold-source ?c - thing)
    (brews ?c - thing)                ; a coffee machine
    (runs-closed ?x - thing)          ; a microwave
    (cooks-when-cut ?x - thing)       ; bread and eggs
    (accepts-cut ?c ?x - thing)       ; a toaster, bread
    (cutter ?x - thing)
    (controls ?s ?d - thing)         ; switching s runs the heat source d: a knob its burner, a toaster itself
    (fills ?s ?b - thing)             ; the tap s runs into the basin b
    (can-lift ?r - robot ?x - item)
    (in-crew ?r - robot ?g - crew)
    (can-lift-together ?g - crew ?x - item)
    (can-help-lift ?h - robot ?x - item) ; is in a crew that can lift it
    (exclusive ?c - fixture)          ; one robot at a time stands here; only where a scene or a task says so
    (one-handed ?r - robot)
    (many-handed ?r - robot)
    (next ?n ?m - count))

  ; ---------------------------------------------------------------- going

  (:action GoToObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r GoToObject) (placed ?x) (mobile ?r)
                       (forall (?c - fixture ?o - robot)
                         (or (not (exclusive ?c)) (= ?o ?r) (not (at ?o ?c))
                             (and (not (= ?x ?c)) (not (in ?x ?c))))))
    :effect (and
      (forall (?y - thing) (not (at ?r ?y)))
      (forall (?f - Floor) (at ?r ?f))
      (at ?r ?x)
      (forall (?c - thing) (when (and (in ?x ?c) (placed ?c)) (at ?r ?c)))
      (forall (?y - item) (when (in ?y ?x) (at ?r ?y)))))

  ; ---------------------------------------------------------------- carrying

  (:action PickupObject
    :parameters (?r - robot ?x - item ?c - thing)
    :precondition (and (has ?r PickupObject) (can-lift ?r ?x) (hand-free ?r) (pickupable ?x)
                       (in ?x ?c) (at ?r ?x) (at ?r ?c) (exposed ?c) (accessible ?c)
                       (forall (?h - robot) (not (supporting ?h ?x))))
    :effect (and
      (holding ?r ?x)
      (not (in ?x ?c))
      (not (placed ?x))
      (not (exposed ?x))
      (not (heating ?x))
      (not (cooling ?x))
      (forall (?a - robot) (not (at ?a ?x)))
      (when (one-handed ?r) (not (hand-free ?r)))
      (when (and (many-handed ?r) (free-hands ?r one)) (not (hand-free ?r)))
      (forall (?n ?m - count)
        (when (and (many-handed ?r) (next ?m ?n) (free-hands ?r ?n))
              (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (armed ?r))))

  (:action PutObject
    :parameters (?r - robot ?x - item ?c - thing)
    :precondition (and (has ?r PutObject) (can-lift ?r ?x) (holding ?r ?x)
                       (accepts ?c ?x) (accessible ?c) (exposed ?c) (at ?r ?c))
    :effect (and
      (not (holding ?r ?x))
      (in ?x ?c)
      (placed ?x)
      (at ?r ?x)
      (when (fixed ?c) (exposed ?x))
      ; into heat
      (when (heating ?c) (and (hot ?x) (not (cold ?x))))
      (when (and (heating ?c) (cookable ?x)) (cooked ?x))
      (when (and (heating ?c) (heat-source ?c) (receptacle ?x)) (heating ?x))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x)) (and (hot ?y) (not (cold ?y)))))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x) (cookable ?y)) (cooked ?y)))
      (when (and (heating ?c) (brews ?c) (fillable ?x) (not (filled ?x)))
            (and (filled ?x) (filled-with ?x coffee)))
      ; into cold
      (when (cooling ?c) (and (cold ?x) (not (hot ?x))))
      (when (and (cold-source ?c) (receptacle ?x)) (cooling ?x))
      (forall (?y - item) (when (and (cooling ?c) (in ?y ?x)) (and (cold ?y) (not (hot ?y)))))
      ; under running water
      (when (rinsing ?c) (not (dirty ?x)))
      (when (and (rinsing ?c) (fillable ?x) (not (filled ?x))) (and (filled ?x) (filled-with ?x water)))
      (hand-free ?r)
      (forall (?n ?m - count)
        (when (and (many-handed ?r) (next ?n ?m) (free-hands ?r ?n))
              (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (not (armed ?r)))
      (forall (?k - item)
        (when (and (many-handed ?r) (cutter ?x) (cutter ?k) (not (= ?k ?x)) (holding ?r ?k)) (armed ?r)))))

  ; Lets go where the robot stands: on the floor. Nothing breaks.
  (:action DropHandObject
    :parameters (?r - robot ?x - item)
    :precondition (and (has ?r DropHandObject) (can-lift ?r ?x) (holding ?r ?x))
    :effect (and
      (not (holding ?r ?x))
      (forall (?f - Floor) (in ?x ?f))
      (placed ?x)
      (exposed ?x)
      (at ?r ?x)
      (hand-free ?r)
      (forall (?n ?m - count)
        (when (and (many-handed ?r) (next ?n ?m) (free-hands ?r ?n))
              (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (not (armed ?r)))
      (forall (?k - item)
        (when (and (many-handed ?r) (cutter ?x) (cutter ?k) (not (= ?k ?x)) (holding ?r ?k)) (armed ?r)))))

  ; Throws it across the room: it ends on the floor, out of reach, and breaks if it can.
  (:action ThrowObject
    :parameters (?r - robot ?x - item)
    :precondition (and (has ?r ThrowObject) (can-lift ?r ?x) (holding ?r ?x))
    :effect (and
      (not (holding ?r ?x))
      (forall (?f - Floor) (in ?x ?f))
      (placed ?x)
      (exposed ?x)
      (when (breakable ?x) (and
        (broken ?x)
        (not (toggled ?x))
        (not (can-switch-on ?x))
        (not (heating ?x))
        (not (accessible ?x))
        (not (filled ?x))
        (forall (?l - liquid) (not (filled-with ?x ?l)))
        (when (shatters ?x) (not (pickupable ?x)))
        (when (cooks-when-cut ?x) (cookable ?x))))
      (hand-free ?r)
      (forall (?n ?m - count)
        (when (and (many-handed ?r) (next ?n ?m) (free-hands ?r ?n))
              (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (not (armed ?r)))
      (forall (?k - item)
        (when (and (many-handed ?r) (cutter ?x) (cutter ?k) (not (= ?k ?x)) (holding ?r ?k)) (armed ?r)))))

  (:action PushObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r PushObject) (pushable ?x) (at ?r ?x) (exposed ?x))
    :effect (moved ?x))

  (:action PullObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r PullObject) (pushable ?x) (at ?r ?x) (exposed ?x))
    :effect (moved ?x))

  ; ---------------------------------------------------------------- carrying together
  ; What is too heavy for one robot is lifted by a crew: all of it but one offer a hand, and that one leads.
  ; Until the thing is put down they stay with the leader. No one of a crew is idle: without any of them the
  ; others could not lift the thing.

  (:action SupportObject
    :parameters (?h - robot ?x - item)
    :precondition (and (has ?h PickupObject) (can-help-lift ?h ?x) (hand-free ?h) (mobile ?h) (pickupable ?x)
                       (at ?h ?x) (exposed ?x))
    :effect (and
      (supporting ?h ?x)
      (not (mobile ?h))
      (when (one-handed ?h) (not (hand-free ?h)))
      (when (and (many-handed ?h) (free-hands ?h one)) (not (hand-free ?h)))
      (forall (?n ?m - count)
        (when (and (many-handed ?h) (next ?m ?n) (free-hands ?h ?n))
              (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))))

  ; Takes the hand back, as long as nothing is lifted.
  (:action WithdrawHand
    :parameters (?h - robot ?x - item)
    :precondition (and (has ?h PickupObject) (supporting ?h ?x) (placed ?x))
    :effect (and
      (not (supporting ?h ?x))
      (mobile ?h)
      (hand-free ?h)
      (forall (?n ?m - count)
        (when (and (many-handed ?h) (next ?n ?m) (free-hands ?h ?n))
              (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))))

  (:action PickupTogether
    :parameters (?r - robot ?g - crew ?x - item ?c - thing)
    :precondition (and (has ?r PickupObject) (in-crew ?r ?g) (can-lift-together ?g ?x)
                       (forall (?h - robot) (or (not (in-crew ?h ?g)) (= ?h ?r) (supporting ?h ?x)))
                       (forall (?h - robot) (or (in-crew ?h ?g) (not (supporting ?h ?x))))
                       (hand-free ?r) (mobile ?r) (pickupable ?x)
                       (in ?x ?c) (at ?r ?x) (at ?r ?c) (exposed ?c) (accessible ?c))
    :effect (and
      (holding ?r ?x)
      (forall (?h - robot) (when (and (in-crew ?h ?g) (not (= ?h ?r))) (helping ?h ?r)))
      (forall (?h - robot ?y - thing) (when (and (in-crew ?h ?g) (not (= ?h ?r))) (not (at ?h ?y))))
      (not (in ?x ?c))
      (not (placed ?x))
      (not (exposed ?x))
      (not (heating ?x))
      (not (cooling ?x))
      (forall (?a - robot) (not (at ?a ?x)))
      (when (one-handed ?r) (not (hand-free ?r)))
      (when (and (many-handed ?r) (free-hands ?r one)) (not (hand-free ?r)))
      (forall (?n ?m - count)
        (when (and (many-handed ?r) (next ?m ?n) (free-hands ?r ?n))
              (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (armed ?r))))

  (:action PutTogether
    :parameters (?r - robot ?g - crew ?x - item ?c - thing)
    :precondition (and (has ?r PutObject)
                       (in-crew ?r ?g) (can-lift-together ?g ?x) (holding ?r ?x)
                       (forall (?h - robot)
                         (or (not (in-crew ?h ?g)) (= ?h ?r) (and (helping ?h ?r) (supporting ?h ?x))))
                       (accepts ?c ?x) (accessible ?c) (exposed ?c) (at ?r ?c))
    :effect (and
      (not (holding ?r ?x))
      (forall (?h - robot)
        (when (and (in-crew ?h ?g) (not (= ?h ?r)))
              (and (not (supporting ?h ?x)) (not (helping ?h ?r)) (mobile ?h) (hand-free ?h)
                   (at ?h ?c) (at ?h ?x))))
      (forall (?h - robot ?f - Floor) (when (and (in-crew ?h ?g) (not (= ?h ?r))) (at ?h ?f)))
      (in ?x ?c)
      (placed ?x)
      (at ?r ?x)
      (when (fixed ?c) (exposed ?x))
      ; into heat
      (when (heating ?c) (and (hot ?x) (not (cold ?x))))
      (when (and (heating ?c) (cookable ?x)) (cooked ?x))
      (when (and (heating ?c) (heat-source ?c) (receptacle ?x)) (heating ?x))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x)) (and (hot ?y) (not (cold ?y)))))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x) (cookable ?y)) (cooked ?y)))
      (when (and (heating ?c) (brews ?c) (fillable ?x) (not (filled ?x)))
            (and (filled ?x) (filled-with ?x coffee)))
      ; into cold
      (when (cooling ?c) (and (cold ?x) (not (hot ?x))))
      (when (and (cold-source ?c) (receptacle ?x)) (cooling ?x))
      (forall (?y - item) (when (and (cooling ?c) (in ?y ?x)) (and (cold ?y) (not (hot ?y)))))
      ; under running water
      (when (rinsing ?c) (not (dirty ?x)))
      (when (and (rinsing ?c) (fillable ?x) (not (filled ?x))) (and (filled ?x) (filled-with ?x water)))
      (hand-free ?r)
      (forall (?n ?m - count)
        (when (and (many-handed ?r) (next ?n ?m) (free-hands ?r ?n))
              (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (not (armed ?r)))
      (forall (?k - item)
        (when (and (many-handed ?r) (cutter ?x) (cutter ?k) (not (= ?k ?x)) (holding ?r ?k)) (armed ?r)))
      (forall (?h - robot ?n ?m - count)
        (when (and (in-crew ?h ?g) (not (= ?h ?r)) (many-handed ?h) (next ?n ?m) (free-hands ?h ?n))
              (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))))

  ; ---------------------------------------------------------------- doors and switches

  (:action OpenObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r OpenObject) (openable ?x) (can-open ?x) (at ?r ?x) (exposed ?x) (not (open ?x)))
    :effect (and
      (open ?x)
      (when (runs-closed ?x) (not (can-switch-on ?x)))
      (when (encloses ?x) (accessible ?x))
      (forall (?y - item) (when (and (encloses ?x) (fixed ?x) (in ?y ?x)) (exposed ?y)))))

  (:action CloseObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r CloseObject) (openable ?x) (at ?r ?x) (exposed ?x) (open ?x))
    :effect (and
      (not (open ?x))
      (when (runs-closed ?x) (can-switch-on ?x))
      (when (encloses ?x) (not (accessible ?x)))
      (forall (?y - item) (when (and (encloses ?x) (fixed ?x) (in ?y ?x)) (not (exposed ?y))))))

  (:action SwitchOn
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r SwitchOn)
                       (toggleable ?x) (can-switch-on ?x) (at ?r ?x) (exposed ?x) (not (toggled ?x)))
    :effect (and
      (toggled ?x)
      (when (runs-closed ?x) (not (can-open ?x)))
      ; a heat source: itself, what it holds, and what that holds
      (forall (?d - heater) (when (controls ?x ?d) (and (toggled ?d) (heating ?d))))
      (forall (?d - heater ?y - item) (when (and (controls ?x ?d) (in ?y ?d)) (and (hot ?y) (not (cold ?y)))))
      (forall (?d - heater ?y - vessel) (when (and (controls ?x ?d) (in ?y ?d)) (heating ?y)))
      (forall (?d - heater ?y - item) (when (and (controls ?x ?d) (in ?y ?d) (cookable ?y)) (cooked ?y)))
      (forall (?d - heater ?y - vessel ?z - item)
        (when (and (controls ?x ?d) (in ?y ?d) (in ?z ?y)) (and (hot ?z) (not (cold ?z)))))
      (forall (?d - heater ?y - vessel ?z - item)
        (when (and (controls ?x ?d) (in ?y ?d) (in ?z ?y) (cookable ?z)) (cooked ?z)))
      (forall (?d - heater ?y - vessel)
        (when (and (controls ?x ?d) (brews ?d) (in ?y ?d) (fillable ?y) (not (filled ?y)))
              (and (filled ?y) (filled-with ?y coffee))))
      ; a tap: what stands in its basin becomes clean and full
      (forall (?b - basin) (when (fills ?x ?b) (rinsing ?b)))
      (forall (?b - basin ?y - item) (when (and (fills ?x ?b) (in ?y ?b)) (not (dirty ?y))))
      (forall (?b - basin ?y - item)
        (when (and (fills ?x ?b) (in ?y ?b) (fillable ?y) (not (filled ?y)))
              (and (filled ?y) (filled-with ?y water))))))

  (:action SwitchOff
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r SwitchOff) (toggleable ?x) (at ?r ?x) (exposed ?x) (toggled ?x))
    :effect (and
      (not (toggled ?x))
      (when (runs-closed ?x) (can-open ?x))
      (forall (?d - heater) (when (controls ?x ?d) (and (not (toggled ?d)) (not (heating ?d)))))
      (forall (?d - heater ?y - vessel) (when (and (controls ?x ?d) (in ?y ?d)) (not (heating ?y))))
      (forall (?b - basin) (when (fills ?x ?b) (not (rinsing ?b))))))

  ; ---------------------------------------------------------------- changing things

  (:action SliceObject
    :parameters (?r - robot ?x - item)
    :precondition (and (has ?r SliceObject)
                       (sliceable ?x) (armed ?r) (at ?r ?x) (exposed ?x) (not (sliced ?x)) (not (broken ?x)))
    :effect (and
      (sliced ?x)
      (when (cooks-when-cut ?x) (cookable ?x))
      (forall (?c - thing) (when (and (cooks-when-cut ?x) (in ?x ?c) (heating ?c)) (cooked ?x)))
      (forall (?c - thing) (when (accepts-cut ?c ?x) (accepts ?c ?x)))))

  (:action BreakObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r BreakObject)
                       (breakable ?x) (at ?r ?x) (exposed ?x) (not (broken ?x)) (not (sliced ?x)))
    :effect (and
      (broken ?x)
      (not (toggled ?x))
      (not (can-switch-on ?x))
      (not (heating ?x))
      (not (accessible ?x))
      (not (filled ?x))
      (forall (?l - liquid) (not (filled-with ?x ?l)))
      (when (shatters ?x) (not (pickupable ?x)))
      (when (cooks-when-cut ?x) (cookable ?x))))

  (:action CleanObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r CleanObject) (dirtyable ?x) (dirty ?x) (at ?r ?x) (exposed ?x))
    :effect (not (dirty ?x)))

  (:action DirtyObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r DirtyObject) (dirtyable ?x) (at ?r ?x) (exposed ?x) (not (dirty ?x)))
    :effect (dirty ?x))

  (:action FillObject
    :parameters (?r - robot ?x - thing ?l - liquid)
    :precondition (and (has ?r FillObject)
                       (fillable ?x) (at ?r ?x) (exposed ?x) (not (filled ?x)) (not (broken ?x)))
    :effect (and (filled ?x) (filled-with ?x ?l)))

  (:action EmptyObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r EmptyObject) (fillable ?x) (at ?r ?x) (exposed ?x) (filled ?x))
    :effect (and (not (filled ?x)) (forall (?l - liquid) (not (filled-with ?x ?l)))))

  ; The last of the soap, the tissues, the paper.
  (:action UseUpObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r UseUpObject) (consumable ?x) (at ?r ?x) (exposed ?x) (not (used-up ?x)))
    :effect (used-up ?x))

  ; ---------------------------------------------------------------- nobody's skill
  ; What happens in a home without the team: somebody carries a thing elsewhere, somebody shuts a door.

  (:action ObjectMoved
    :parameters (?x - item ?to - thing)
    :precondition (and (placed ?x) (accepts ?to ?x) (accessible ?to) (exposed ?to) (not (in ?x ?to))
                       (not (heating ?to)) (not (cooling ?to)) (not (rinsing ?to))
                       (forall (?h - robot) (not (supporting ?h ?x))))
    :effect (and
      (forall (?c - thing) (not (in ?x ?c)))
      (in ?x ?to)
      (not (exposed ?x))
      (when (fixed ?to) (exposed ?x))
      (not (heating ?x))
      (not (cooling ?x))
      (forall (?r - robot) (not (at ?r ?x)))))

  (:action DoorClosed
    :parameters (?x - thing)
    :precondition (and (openable ?x) (exposed ?x) (open ?x))
    :effect (and
      (not (open ?x))
      (when (runs-closed ?x) (can-switch-on ?x))
      (when (encloses ?x) (not (accessible ?x)))
      (forall (?y - item) (when (and (encloses ?x) (fixed ?x) (in ?y ?x)) (not (exposed ?y))))))

  ; What the arbiter does to the world when a robot's process is gone: what it held, alone or with another,
  ; lies on the floor, and the robot is nowhere.

  (:action RobotLost
    :parameters (?r - robot)
    :precondition (and)
    :effect (and
      (not (hand-free ?r))
      (not (armed ?r))
      (not (mobile ?r))
      (forall (?y - thing) (not (at ?r ?y)))
      (forall (?x - item ?f - Floor)
        (when (holding ?r ?x) (and (not (holding ?r ?x)) (in ?x ?f) (placed ?x) (exposed ?x))))
      ; it led: its helpers are free again
      (forall (?h - robot) (when (helping ?h ?r) (and (not (helping ?h ?r)) (mobile ?h) (hand-free ?h))))
      (forall (?h - robot ?n ?m - count)
        (when (and (helping ?h ?r) (next ?n ?m) (free-hands ?h ?n))
              (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))
      (forall (?h - robot ?x - item) (when (helping ?h ?r) (not (supporting ?h ?x))))
      (forall (?h - robot ?f - Floor) (when (helping ?h ?r) (at ?h ?f)))
      ; it helped: the leader cannot hold on without it, and who else helped with that is free again
      (forall (?x - item) (not (supporting ?r ?x)))
      (forall (?l - robot) (when (helping ?r ?l) (and (not (helping ?r ?l)) (hand-free ?l))))
      (forall (?l - robot ?n ?m - count)
        (when (and (helping ?r ?l) (next ?n ?m) (free-hands ?l ?n))
              (and (not (free-hands ?l ?n)) (free-hands ?l ?m))))
      (forall (?l ?h - robot ?x - item ?f - Floor)
        (when (and (helping ?r ?l) (helping ?h ?l) (not (= ?h ?r)) (supporting ?r ?x) (supporting ?h ?x))
              (and (not (helping ?h ?l)) (not (supporting ?h ?x)) (mobile ?h) (hand-free ?h) (at ?h ?f))))
      (forall (?l ?h - robot ?x - item ?n ?m - count)
        (when (and (helping ?r ?l) (helping ?h ?l) (not (= ?h ?r)) (supporting ?r ?x) (supporting ?h ?x)
                   (next ?n ?m) (free-hands ?h ?n))
              (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))
      (forall (?l - robot ?x - item ?f - Floor)
        (when (and (helping ?r ?l) (supporting ?r ?x))
              (and (not (holding ?l ?x)) (in ?x ?f) (placed ?x) (exposed ?x)))))))
