(define (domain household)
  (:requirements
    :strips
    :typing
    :equality
    :negative-preconditions
    :disjunctive-preconditions
    :universal-preconditions
    :conditional-effects)
  (:types
    robot crew thing liquid count skill - object
    fixture item - thing
    vessel - item
    heater basin ArmChair Bed Blinds Cabinet Chair CoffeeTable CounterTop Curtains Desk DeskLamp Desktop DiningTable DogBed Drawer Dresser Faucet Floor FloorLamp Fridge GarbageBag GarbageCan HandTowelHolder HousePlant LaundryHamper LightSwitch Mirror Ottoman Painting Poster RoomDecor Safe Shelf ShelvingUnit ShowerCurtain ShowerDoor ShowerGlass ShowerHead SideTable Sofa Stool StoveKnob TVStand TargetCircle Television Toilet ToiletPaperHanger TowelHolder VacuumCleaner Window - fixture
    AlarmClock AluminumFoil Apple BaseballBat BasketBall Book Boots Bottle Bread ButterKnife CD Candle CellPhone Cloth CreditCard DishSponge Dumbbell Egg Fork HandTowel Kettle KeyChain Knife Ladle Laptop Lettuce Newspaper PaperTowelRoll Pen Pencil PepperShaker Pillow Plunger Potato RemoteControl SaltShaker ScrubBrush SoapBar SoapBottle Spatula Spoon SprayBottle Statue TableTopDecor TeddyBear TennisRacket TissueBox ToiletPaper Tomato Towel Vase Watch WateringCan WineBottle - item
    Bowl Box Cup Footstool Mug Pan Plate Pot - vessel
    CoffeeMachine Microwave StoveBurner Toaster - heater
    Bathtub Sink - basin
    SinkBasin - Sink
    BathtubBasin - Bathtub
    AppleSliced - Apple
    BreadSliced - Bread
    LettuceSliced - Lettuce
    PotatoSliced - Potato
    TomatoSliced - Tomato
    EggCracked - Egg)
  (:constants
    water coffee wine - liquid
    none one two three four - count
    GoToObject PickupObject PutObject OpenObject CloseObject SwitchOn SwitchOff SliceObject BreakObject CleanObject DirtyObject FillObject EmptyObject UseUpObject DropHandObject ThrowObject PushObject PullObject - skill)
  (:predicates
    (at ?r - robot ?x - thing)
    (holding ?r - robot ?x - item)
    (in ?x ?c - thing)
    (open ?x - thing)
    (toggled ?x - thing)
    (sliced ?x - thing)
    (broken ?x - thing)
    (cooked ?x - thing)
    (dirty ?x - thing)
    (filled ?x - thing)
    (filled-with ?x - thing ?l - liquid)
    (hot ?x - thing)
    (cold ?x - thing)
    (used-up ?x - thing)
    (moved ?x - thing)
    (placed ?x - thing)
    (exposed ?x - thing)
    (accessible ?c - thing)
    (pickupable ?x - thing)
    (can-open ?x - thing)
    (can-switch-on ?x - thing)
    (cookable ?x - thing)
    (accepts ?c ?x - thing)
    (heating ?c - thing)
    (cooling ?c - thing)
    (rinsing ?c - thing)
    (hand-free ?r - robot)
    (free-hands ?r - robot ?n - count)
    (armed ?r - robot)
    (mobile ?r - robot)
    (supporting ?h - robot ?x - item)
    (helping ?h ?r - robot)
    (has ?r - robot ?s - skill)
    (openable ?x - thing)
    (encloses ?c - thing)
    (fixed ?c - thing)
    (toggleable ?x - thing)
    (sliceable ?x - thing)
    (breakable ?x - thing)
    (shatters ?x - thing)
    (dirtyable ?x - thing)
    (fillable ?x - thing)
    (pushable ?x - thing)
    (consumable ?x - thing)
    (receptacle ?c - thing)
    (heat-source ?c - thing)
    (cold-source ?c - thing)
    (brews ?c - thing)
    (runs-closed ?x - thing)
    (cooks-when-cut ?x - thing)
    (accepts-cut ?c ?x - thing)
    (cutter ?x - thing)
    (controls ?s ?d - thing)
    (fills ?s ?b - thing)
    (can-lift ?r - robot ?x - item)
    (in-crew ?r - robot ?g - crew)
    (can-lift-together ?g - crew ?x - item)
    (can-help-lift ?h - robot ?x - item)
    (exclusive ?c - fixture)
    (one-handed ?r - robot)
    (many-handed ?r - robot)
    (next ?n ?m - count))
  (:action GoToObject
    :parameters (?r - robot ?x - thing)
    :precondition (and
      (has ?r GoToObject)
      (placed ?x)
      (mobile ?r)
      (forall
        (?c - fixture ?o - robot)
        (or (not (exclusive ?c)) (= ?o ?r) (not (at ?o ?c)) (and (not (= ?x ?c)) (not (in ?x ?c))))))
    :effect (and
      (forall (?y - thing) (not (at ?r ?y)))
      (forall (?f - Floor) (at ?r ?f))
      (at ?r ?x)
      (forall (?c - thing) (when (and (in ?x ?c) (placed ?c)) (at ?r ?c)))
      (forall (?y - item) (when (in ?y ?x) (at ?r ?y)))))
  (:action PickupObject
    :parameters (?r - robot ?x - item ?c - thing)
    :precondition (and
      (has ?r PickupObject)
      (can-lift ?r ?x)
      (hand-free ?r)
      (pickupable ?x)
      (in ?x ?c)
      (at ?r ?x)
      (at ?r ?c)
      (exposed ?c)
      (accessible ?c)
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
      (forall
        (?n ?m - count)
        (when
          (and (many-handed ?r) (next ?m ?n) (free-hands ?r ?n))
          (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (armed ?r))))
  (:action PutObject
    :parameters (?r - robot ?x - item ?c - thing)
    :precondition (and
      (has ?r PutObject)
      (can-lift ?r ?x)
      (holding ?r ?x)
      (accepts ?c ?x)
      (accessible ?c)
      (exposed ?c)
      (at ?r ?c))
    :effect (and
      (not (holding ?r ?x))
      (in ?x ?c)
      (placed ?x)
      (at ?r ?x)
      (when (fixed ?c) (exposed ?x))
      (when (heating ?c) (and (hot ?x) (not (cold ?x))))
      (when (and (heating ?c) (cookable ?x)) (cooked ?x))
      (when (and (heating ?c) (heat-source ?c) (receptacle ?x)) (heating ?x))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x)) (and (hot ?y) (not (cold ?y)))))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x) (cookable ?y)) (cooked ?y)))
      (when
        (and (heating ?c) (brews ?c) (fillable ?x) (not (filled ?x)))
        (and (filled ?x) (filled-with ?x coffee)))
      (when (cooling ?c) (and (cold ?x) (not (hot ?x))))
      (when (and (cold-source ?c) (receptacle ?x)) (cooling ?x))
      (forall (?y - item) (when (and (cooling ?c) (in ?y ?x)) (and (cold ?y) (not (hot ?y)))))
      (when (rinsing ?c) (not (dirty ?x)))
      (when
        (and (rinsing ?c) (fillable ?x) (not (filled ?x)))
        (and (filled ?x) (filled-with ?x water)))
      (hand-free ?r)
      (forall
        (?n ?m - count)
        (when
          (and (many-handed ?r) (next ?n ?m) (free-hands ?r ?n))
          (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (not (armed ?r)))
      (forall
        (?k - item)
        (when
          (and (many-handed ?r) (cutter ?x) (cutter ?k) (not (= ?k ?x)) (holding ?r ?k))
          (armed ?r)))))
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
      (forall
        (?n ?m - count)
        (when
          (and (many-handed ?r) (next ?n ?m) (free-hands ?r ?n))
          (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (not (armed ?r)))
      (forall
        (?k - item)
        (when
          (and (many-handed ?r) (cutter ?x) (cutter ?k) (not (= ?k ?x)) (holding ?r ?k))
          (armed ?r)))))
  (:action PushObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r PushObject) (pushable ?x) (at ?r ?x) (exposed ?x))
    :effect (moved ?x))
  (:action PullObject
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r PullObject) (pushable ?x) (at ?r ?x) (exposed ?x))
    :effect (moved ?x))
  (:action SupportObject
    :parameters (?h - robot ?x - item)
    :precondition (and
      (has ?h PickupObject)
      (can-help-lift ?h ?x)
      (hand-free ?h)
      (mobile ?h)
      (pickupable ?x)
      (at ?h ?x)
      (exposed ?x))
    :effect (and
      (supporting ?h ?x)
      (not (mobile ?h))
      (when (one-handed ?h) (not (hand-free ?h)))
      (when (and (many-handed ?h) (free-hands ?h one)) (not (hand-free ?h)))
      (forall
        (?n ?m - count)
        (when
          (and (many-handed ?h) (next ?m ?n) (free-hands ?h ?n))
          (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))))
  (:action WithdrawHand
    :parameters (?h - robot ?x - item)
    :precondition (and (has ?h PickupObject) (supporting ?h ?x) (placed ?x))
    :effect (and
      (not (supporting ?h ?x))
      (mobile ?h)
      (hand-free ?h)
      (forall
        (?n ?m - count)
        (when
          (and (many-handed ?h) (next ?n ?m) (free-hands ?h ?n))
          (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))))
  (:action PickupTogether
    :parameters (?r - robot ?g - crew ?x - item ?c - thing)
    :precondition (and
      (has ?r PickupObject)
      (in-crew ?r ?g)
      (can-lift-together ?g ?x)
      (forall (?h - robot) (or (not (in-crew ?h ?g)) (= ?h ?r) (supporting ?h ?x)))
      (forall (?h - robot) (or (in-crew ?h ?g) (not (supporting ?h ?x))))
      (hand-free ?r)
      (mobile ?r)
      (pickupable ?x)
      (in ?x ?c)
      (at ?r ?x)
      (at ?r ?c)
      (exposed ?c)
      (accessible ?c))
    :effect (and
      (holding ?r ?x)
      (forall (?h - robot) (when (and (in-crew ?h ?g) (not (= ?h ?r))) (helping ?h ?r)))
      (forall
        (?h - robot ?y - thing)
        (when (and (in-crew ?h ?g) (not (= ?h ?r))) (not (at ?h ?y))))
      (not (in ?x ?c))
      (not (placed ?x))
      (not (exposed ?x))
      (not (heating ?x))
      (not (cooling ?x))
      (forall (?a - robot) (not (at ?a ?x)))
      (when (one-handed ?r) (not (hand-free ?r)))
      (when (and (many-handed ?r) (free-hands ?r one)) (not (hand-free ?r)))
      (forall
        (?n ?m - count)
        (when
          (and (many-handed ?r) (next ?m ?n) (free-hands ?r ?n))
          (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (armed ?r))))
  (:action PutTogether
    :parameters (?r - robot ?g - crew ?x - item ?c - thing)
    :precondition (and
      (has ?r PutObject)
      (in-crew ?r ?g)
      (can-lift-together ?g ?x)
      (holding ?r ?x)
      (forall
        (?h - robot)
        (or (not (in-crew ?h ?g)) (= ?h ?r) (and (helping ?h ?r) (supporting ?h ?x))))
      (accepts ?c ?x)
      (accessible ?c)
      (exposed ?c)
      (at ?r ?c))
    :effect (and
      (not (holding ?r ?x))
      (forall
        (?h - robot)
        (when
          (and (in-crew ?h ?g) (not (= ?h ?r)))
          (and
            (not (supporting ?h ?x))
            (not (helping ?h ?r))
            (mobile ?h)
            (hand-free ?h)
            (at ?h ?c)
            (at ?h ?x))))
      (forall (?h - robot ?f - Floor) (when (and (in-crew ?h ?g) (not (= ?h ?r))) (at ?h ?f)))
      (in ?x ?c)
      (placed ?x)
      (at ?r ?x)
      (when (fixed ?c) (exposed ?x))
      (when (heating ?c) (and (hot ?x) (not (cold ?x))))
      (when (and (heating ?c) (cookable ?x)) (cooked ?x))
      (when (and (heating ?c) (heat-source ?c) (receptacle ?x)) (heating ?x))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x)) (and (hot ?y) (not (cold ?y)))))
      (forall (?y - item) (when (and (heating ?c) (in ?y ?x) (cookable ?y)) (cooked ?y)))
      (when
        (and (heating ?c) (brews ?c) (fillable ?x) (not (filled ?x)))
        (and (filled ?x) (filled-with ?x coffee)))
      (when (cooling ?c) (and (cold ?x) (not (hot ?x))))
      (when (and (cold-source ?c) (receptacle ?x)) (cooling ?x))
      (forall (?y - item) (when (and (cooling ?c) (in ?y ?x)) (and (cold ?y) (not (hot ?y)))))
      (when (rinsing ?c) (not (dirty ?x)))
      (when
        (and (rinsing ?c) (fillable ?x) (not (filled ?x)))
        (and (filled ?x) (filled-with ?x water)))
      (hand-free ?r)
      (forall
        (?n ?m - count)
        (when
          (and (many-handed ?r) (next ?n ?m) (free-hands ?r ?n))
          (and (not (free-hands ?r ?n)) (free-hands ?r ?m))))
      (when (cutter ?x) (not (armed ?r)))
      (forall
        (?k - item)
        (when
          (and (many-handed ?r) (cutter ?x) (cutter ?k) (not (= ?k ?x)) (holding ?r ?k))
          (armed ?r)))
      (forall
        (?h - robot ?n ?m - count)
        (when
          (and (in-crew ?h ?g) (not (= ?h ?r)) (many-handed ?h) (next ?n ?m) (free-hands ?h ?n))
          (and (not (free-hands ?h ?n)) (free-hands ?h ?m))))))
  (:action SwitchOn
    :parameters (?r - robot ?x - thing)
    :precondition (and
      (has ?r SwitchOn)
      (toggleable ?x)
      (can-switch-on ?x)
      (at ?r ?x)
      (exposed ?x)
      (not (toggled ?x)))
    :effect (and
      (toggled ?x)
      (when (runs-closed ?x) (not (can-open ?x)))
      (forall (?d - heater) (when (controls ?x ?d) (and (toggled ?d) (heating ?d))))
      (forall
        (?d - heater ?y - item)
        (when (and (controls ?x ?d) (in ?y ?d)) (and (hot ?y) (not (cold ?y)))))
      (forall (?d - heater ?y - vessel) (when (and (controls ?x ?d) (in ?y ?d)) (heating ?y)))
      (forall
        (?d - heater ?y - item)
        (when (and (controls ?x ?d) (in ?y ?d) (cookable ?y)) (cooked ?y)))
      (forall
        (?d - heater ?y - vessel ?z - item)
        (when (and (controls ?x ?d) (in ?y ?d) (in ?z ?y)) (and (hot ?z) (not (cold ?z)))))
      (forall
        (?d - heater ?y - vessel ?z - item)
        (when (and (controls ?x ?d) (in ?y ?d) (in ?z ?y) (cookable ?z)) (cooked ?z)))
      (forall
        (?d - heater ?y - vessel)
        (when
          (and (controls ?x ?d) (brews ?d) (in ?y ?d) (fillable ?y) (not (filled ?y)))
          (and (filled ?y) (filled-with ?y coffee))))
      (forall (?b - basin) (when (fills ?x ?b) (rinsing ?b)))
      (forall (?b - basin ?y - item) (when (and (fills ?x ?b) (in ?y ?b)) (not (dirty ?y))))
      (forall
        (?b - basin ?y - item)
        (when
          (and (fills ?x ?b) (in ?y ?b) (fillable ?y) (not (filled ?y)))
          (and (filled ?y) (filled-with ?y water))))))
  (:action SwitchOff
    :parameters (?r - robot ?x - thing)
    :precondition (and (has ?r SwitchOff) (toggleable ?x) (at ?r ?x) (exposed ?x) (toggled ?x))
    :effect (and
      (not (toggled ?x))
      (when (runs-closed ?x) (can-open ?x))
      (forall (?d - heater) (when (controls ?x ?d) (and (not (toggled ?d)) (not (heating ?d)))))
      (forall
        (?d - heater ?y - vessel)
        (when (and (controls ?x ?d) (in ?y ?d)) (not (heating ?y))))
      (forall (?b - basin) (when (fills ?x ?b) (not (rinsing ?b))))))
  (:action SliceObject
    :parameters (?r - robot ?x - item)
    :precondition (and
      (has ?r SliceObject)
      (sliceable ?x)
      (armed ?r)
      (at ?r ?x)
      (exposed ?x)
      (not (sliced ?x))
      (not (broken ?x)))
    :effect (and
      (sliced ?x)
      (when (cooks-when-cut ?x) (cookable ?x))
      (forall (?c - thing) (when (and (cooks-when-cut ?x) (in ?x ?c) (heating ?c)) (cooked ?x)))
      (forall (?c - thing) (when (accepts-cut ?c ?x) (accepts ?c ?x)))))
  (:action BreakObject
    :parameters (?r - robot ?x - thing)
    :precondition (and
      (has ?r BreakObject)
      (breakable ?x)
      (at ?r ?x)
      (exposed ?x)
      (not (broken ?x))
      (not (sliced ?x)))
    :effect (and
      (broken ?x)
      (not (toggled ?x))
      (not (can-switch-on ?x))
      (not (heating ?x))
      (not (accessible ?x))
      (not (filled ?x))
      (forall (?l - liquid) (not (filled-with ?x ?l)))
      (when (shatters ?x) (not (pickupable ?x)))
      (when (cooks-when-cut ?x) (cookable ?x)))))
