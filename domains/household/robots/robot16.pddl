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
  (:action ThrowObject
    :parameters (?r - robot ?x - item)
    :precondition (and (has ?r ThrowObject) (can-lift ?r ?x) (holding ?r ?x))
    :effect (and
      (not (holding ?r ?x))
      (forall (?f - Floor) (in ?x ?f))
      (placed ?x)
      (exposed ?x)
      (when
        (breakable ?x)
        (and
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
